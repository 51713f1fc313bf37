#include <viwo/core/Error.h>
#include <viwo/evaluation/Consistency.h>
#include <viwo/evaluation/TrajectoryErrors.h>

#include <Eigen/Cholesky>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>

namespace viwo
{
namespace
{
/** Other programs may write Unix time through a double, which is good to a quarter of a microsecond. */
constexpr int64_t kSameStamp_ns = 1000;

using Vector4 = Eigen::Vector4d;  // x y z yaw

/** Position and yaw of T in the level frame at the position and yaw of T_first. */
Vector4 relativeToFirst(const Pose3& T_first, const Pose3& T)
{
	const double yaw_first = yawOf(T_first.R);
	Vector4 relative;
	relative.head<3>() = Eigen::AngleAxisd(-yaw_first, Eigen::Vector3d::UnitZ()) * (T.p - T_first.p);
	relative[3] = yawOf(T.R) - yaw_first;
	return relative;
}

Eigen::Matrix4d positionAndYaw(const Eigen::Matrix<double, 6, 6>& covariance)
{
	static const int rows[] = {0, 1, 2, 5};
	Eigen::Matrix4d block;
	for (int i = 0; i < 4; ++i)
		for (int j = 0; j < 4; ++j) block(i, j) = covariance(rows[i], rows[j]);
	return block;
}

/** NEES of the given components, those without a variance left out. @return false when the covariance is not positive definite. */
bool accumulate(const Vector4& error, const Eigen::Matrix4d& covariance, std::initializer_list<int> components, Nees& nees)
{
	std::vector<int> used;
	for (const int c : components)
		if (std::isfinite(covariance(c, c))) used.push_back(c);
	if (used.empty()) return true;
	const auto n = static_cast<Eigen::Index>(used.size());
	Eigen::VectorXd e(n);
	Eigen::MatrixXd P(n, n);
	for (Eigen::Index i = 0; i < n; ++i)
	{
		e[i] = error[used[static_cast<size_t>(i)]];
		for (Eigen::Index j = 0; j < n; ++j) P(i, j) = covariance(used[static_cast<size_t>(i)], used[static_cast<size_t>(j)]);
	}
	const Eigen::LLT<Eigen::MatrixXd> cholesky(P);
	if (!P.allFinite() || cholesky.info() != Eigen::Success) return false;
	nees.add(e.dot(cholesky.solve(e)), used.size());
	return true;
}

class CovarianceLookup
{
   public:
	explicit CovarianceLookup(const std::vector<StampedCovariance>& entries) : entries_(entries) {}

	/** To be called with increasing t_ns. */
	const StampedCovariance* at(int64_t t_ns)
	{
		while (next_ < entries_.size() && entries_[next_].t_ns < t_ns - kSameStamp_ns) ++next_;
		const bool found = next_ < entries_.size() && std::llabs(entries_[next_].t_ns - t_ns) <= kSameStamp_ns;
		return found ? &entries_[next_] : nullptr;
	}

   private:
	const std::vector<StampedCovariance>& entries_;
	size_t next_ = 0;
};
}  // namespace

double Nees::average() const
{
	return degrees_of_freedom > 0 ? sum / static_cast<double>(degrees_of_freedom) : std::numeric_limits<double>::quiet_NaN();
}

Consistency consistency(const Trajectory& reference, const Trajectory& estimate, const std::vector<StampedCovariance>& covariances,
                        double max_gap_s)
{
	const auto matches = matchPoses(reference, estimate, max_gap_s);
	if (matches.size() < 2) throw Error("fewer than two poses match the reference: no consistency can be computed");
	Consistency result;
	CovarianceLookup lookup(covariances);
	for (size_t i = 1; i < matches.size(); ++i)
	{
		const StampedCovariance* entry = lookup.at(matches[i].t_ns);
		if (entry == nullptr)
		{
			++result.without_covariance;
			continue;
		}
		Vector4 error = relativeToFirst(matches[0].T_est, matches[i].T_est) - relativeToFirst(matches[0].T_ref, matches[i].T_ref);
		error[3] = wrapAngle(error[3]);
		const Eigen::Matrix4d P = positionAndYaw(entry->covariance);
		Nees position = result.position, yaw = result.yaw, pose = result.pose;
		if (accumulate(error, P, {0, 1, 2}, position) && accumulate(error, P, {3}, yaw) && accumulate(error, P, {0, 1, 2, 3}, pose))
			result.position = position, result.yaw = yaw, result.pose = pose;
		else
			++result.invalid;
	}
	return result;
}
}  // namespace viwo
