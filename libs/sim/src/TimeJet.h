#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

/** Forward-mode derivatives with respect to time, to second order: a value travels with its first and second derivative. */
namespace viwo::sim
{
struct TimeJet
{
	double f = 0, d = 0, dd = 0;

	TimeJet() = default;
	TimeJet(double value) : f(value) {}  // NOLINT: constants mix freely with jets
	TimeJet(double value, double rate, double acceleration) : f(value), d(rate), dd(acceleration) {}
};

inline TimeJet operator+(const TimeJet& a, const TimeJet& b)
{
	return {a.f + b.f, a.d + b.d, a.dd + b.dd};
}
inline TimeJet operator-(const TimeJet& a, const TimeJet& b)
{
	return {a.f - b.f, a.d - b.d, a.dd - b.dd};
}
inline TimeJet operator-(const TimeJet& a)
{
	return {-a.f, -a.d, -a.dd};
}
inline TimeJet operator*(const TimeJet& a, const TimeJet& b)
{
	return {a.f * b.f, a.d * b.f + a.f * b.d, a.dd * b.f + 2 * a.d * b.d + a.f * b.dd};
}

/** g(a), from g, g' and g'' at a.f. */
inline TimeJet chain(const TimeJet& a, double g, double g1, double g2)
{
	return {g, g1 * a.d, g2 * a.d * a.d + g1 * a.dd};
}

inline TimeJet sin(const TimeJet& a)
{
	return chain(a, std::sin(a.f), std::cos(a.f), -std::sin(a.f));
}
inline TimeJet cos(const TimeJet& a)
{
	return chain(a, std::cos(a.f), -std::sin(a.f), -std::cos(a.f));
}
inline TimeJet inverseSqrt(const TimeJet& a)
{
	const double r = 1 / std::sqrt(a.f);
	return chain(a, r, -0.5 * r / a.f, 0.75 * r / (a.f * a.f));
}

/** A matrix (or vector) with its first and second time derivative. */
template <class Matrix>
struct MatrixJet
{
	Matrix f = Matrix::Zero(), d = Matrix::Zero(), dd = Matrix::Zero();

	void set(Eigen::Index row, Eigen::Index col, const TimeJet& value)
	{
		f(row, col) = value.f;
		d(row, col) = value.d;
		dd(row, col) = value.dd;
	}
};

template <class A, class B>
auto operator*(const MatrixJet<A>& a, const MatrixJet<B>& b)
{
	using Product = Eigen::Matrix<double, A::RowsAtCompileTime, B::ColsAtCompileTime>;
	MatrixJet<Product> c;
	c.f = a.f * b.f;
	c.d = a.d * b.f + a.f * b.d;
	c.dd = a.dd * b.f + 2 * a.d * b.d + a.f * b.dd;
	return c;
}
}  // namespace viwo::sim
