#include "BundleAdjustment.h"

#include <viwo/sfm/ScopedQuietLog.h>

#include <ceres/ceres.h>
#include <ceres/rotation.h>
#include <viwo/core/Ranking.h>
#include <viwo/core/So3.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "Linearisation.h"

namespace viwo::sfm
{
namespace
{
constexpr double kHuber_sigmas = 2;
constexpr double kCostTolerance = 1e-10, kTolerance = 1e-12;
constexpr double kResectionTolerance = 1e-6;
constexpr double kMaxInverseDistanceSigma = 0.7;
constexpr double kMaxResectionShareOff = 0.4;
constexpr double kResectionLimit_sigmas = 8;

/** Error on the tangent plane of the measured bearing, over its sigma. Camera: rotation vector of R_ck_r and p_r_ck. */
struct BearingCost
{
	BearingCost(const Eigen::Vector3d& bearing_, double sigma) : bearing(bearing_), basis(tangentBasis(bearing_) / sigma) {}

	template <typename T>
	bool operator()(const T* rotation, const T* p, const T* X, T* residual) const
	{
		const T from_camera[3] = {X[0] - p[0] * X[3], X[1] - p[1] * X[3], X[2] - p[2] * X[3]};
		T f[3];
		ceres::AngleAxisRotatePoint(rotation, from_camera, f);
		const T depth = bearing.x() * f[0] + bearing.y() * f[1] + bearing.z() * f[2];
		if (depth <= T(1e-9)) return false;
		for (int i = 0; i < 2; ++i) residual[i] = (basis(0, i) * f[0] + basis(1, i) * f[1] + basis(2, i) * f[2]) / depth;
		return true;
	}

	Eigen::Vector3d bearing;
	Eigen::Matrix<double, 3, 2> basis;
};

struct CameraBlock
{
	std::array<double, 3> rotation, p;

	explicit CameraBlock(const Pose3& T_r_ck)
	{
		const Eigen::Vector3d phi = so3::log(T_r_ck.R.conjugate());
		rotation = {phi.x(), phi.y(), phi.z()};
		p = {T_r_ck.p.x(), T_r_ck.p.y(), T_r_ck.p.z()};
	}
	Pose3 pose() const
	{
		return {so3::expQuaternion(Eigen::Map<const Eigen::Vector3d>(rotation.data())).conjugate(),
		        Eigen::Map<const Eigen::Vector3d>(p.data())};
	}
};

ceres::Solver::Options solverOptions(const AdjustmentSettings& settings, ceres::LinearSolverType type)
{
	ceres::Solver::Options options;
	options.linear_solver_type = type;
	options.max_num_iterations = settings.max_iterations;
	options.function_tolerance = kCostTolerance;
	options.gradient_tolerance = kTolerance;
	options.parameter_tolerance = kTolerance;
	options.num_threads = 1;
	options.logging_type = ceres::SILENT;
	return options;
}

void addObservation(ceres::Problem& problem, const Observation& o, double sigma_rad, CameraBlock& camera, double* X)
{
	problem.AddResidualBlock(new ceres::AutoDiffCostFunction<BearingCost, 2, 3, 3, 4>(new BearingCost(o.bearing, sigma_rad)),
	                         new ceres::HuberLoss(kHuber_sigmas), camera.rotation.data(), camera.p.data(), X);
}
}  // namespace

std::optional<Pose3> resect(const Scene& scene, int frame, const Pose3& guess, int min_points, const AdjustmentSettings& settings)
{
	CameraBlock camera(guess);
	std::vector<Eigen::Vector4d> X;
	std::vector<Observation> seen;
	for (const ScenePoint& point : scene.points)
	{
		const Eigen::Vector3d* bearing = point.X ? point.track.bearingIn(frame) : nullptr;
		if (!bearing || bearing->dot(directionOf(*point.X, guess)) <= 0) continue;
		X.push_back(*point.X);
		seen.push_back({frame, *bearing});
	}
	if (static_cast<int>(seen.size()) < min_points) return std::nullopt;
	ceres::Problem problem;
	for (size_t i = 0; i < seen.size(); ++i)
	{
		addObservation(problem, seen[i], settings.sigma_rad, camera, X[i].data());
		problem.SetParameterBlockConstant(X[i].data());
	}
	ceres::Solver::Summary summary;
	ceres::Solver::Options options = solverOptions(settings, ceres::DENSE_QR);
	options.function_tolerance = kResectionTolerance;  // the adjustment follows
	const ScopedQuietLog quiet;
	ceres::Solve(options, &problem, &summary);
	if (!summary.IsSolutionUsable()) return std::nullopt;
	const Pose3 T = camera.pose();
	size_t off = 0;
	for (size_t i = 0; i < seen.size(); ++i)
	{
		const auto e = bearingError(X[i], T, seen[i].bearing);
		off += !e || e->norm() > kResectionLimit_sigmas * settings.sigma_rad;
	}
	if (static_cast<double>(off) > kMaxResectionShareOff * static_cast<double>(seen.size())) return std::nullopt;
	return T;
}

bool adjust(Scene& scene, const AdjustmentSettings& settings)
{
	std::vector<CameraBlock> cameras;
	for (const auto& T : scene.T_r_ck) cameras.emplace_back(T.value());
	ceres::Problem problem;
	auto* ordering = new ceres::ParameterBlockOrdering;
	auto* sphere = new ceres::SphereManifold<4>();
	bool sphere_owned = false;
	for (ScenePoint& point : scene.points)
	{
		if (!point.X) continue;
		for (const Observation& o : point.track.observations)
			addObservation(problem, o, settings.sigma_rad, cameras[static_cast<size_t>(o.frame)], point.X->data());
		problem.SetManifold(point.X->data(), sphere);
		sphere_owned = true;
		ordering->AddElementToGroup(point.X->data(), 0);
	}
	if (!sphere_owned)
	{
		delete sphere;
		delete ordering;
		return false;
	}
	for (CameraBlock& camera : cameras)
	{
		if (!problem.HasParameterBlock(camera.p.data()))
		{
			delete ordering;
			return false;  // a frame that sees none of the points
		}
		ordering->AddElementToGroup(camera.rotation.data(), 1);
		ordering->AddElementToGroup(camera.p.data(), 1);
	}
	CameraBlock& reference = cameras[static_cast<size_t>(scene.reference)];
	problem.SetParameterBlockConstant(reference.rotation.data());
	problem.SetParameterBlockConstant(reference.p.data());
	problem.SetManifold(cameras[static_cast<size_t>(scene.scale_frame)].p.data(), new ceres::SphereManifold<3>());

	ceres::Solver::Options options = solverOptions(settings, ceres::DENSE_SCHUR);
	options.linear_solver_ordering.reset(ordering);
	ceres::Solver::Summary summary;
	const ScopedQuietLog quiet;
	ceres::Solve(options, &problem, &summary);
	for (size_t k = 0; k < cameras.size(); ++k) scene.T_r_ck[k] = cameras[k].pose();
	return summary.IsSolutionUsable();
}

void removeFalsePoints(Scene& scene, double limit_rad)
{
	for (ScenePoint& point : scene.points)
	{
		point.X = triangulate(point.track, scene.T_r_ck);
		if (!point.X) continue;
		const bool fits = std::all_of(point.track.observations.begin(), point.track.observations.end(),
		                              [&](const Observation& o)
		                              {
			                              const auto e =
			                                  bearingError(*point.X, scene.T_r_ck[static_cast<size_t>(o.frame)].value(), o.bearing);
			                              return e && e->norm() <= limit_rad;
		                              });
		if (!fits) point.X.reset();
	}
}

void removeVaguePoints(Scene& scene, double sigma_rad)
{
	std::vector<double> inverse_distances;
	for (const ScenePoint& point : scene.points)
		if (point.X) inverse_distances.push_back(std::max(0.0, point.X->w()) / point.X->head<3>().norm());
	if (inverse_distances.empty()) return;
	const double middle = upperMedian(inverse_distances);
	for (ScenePoint& point : scene.points)
		if (point.X && inverseDistanceSigma(point, scene.T_r_ck, sigma_rad) > kMaxInverseDistanceSigma * middle) point.X.reset();
}

int removeOutliers(Scene& scene, double limit_rad)
{
	int removed = 0;
	for (ScenePoint& point : scene.points)
	{
		if (!point.X) continue;
		std::vector<Observation>& all = point.track.observations;
		const auto end = std::remove_if(all.begin(), all.end(),
		                                [&](const Observation& o)
		                                {
			                                const auto e =
			                                    bearingError(*point.X, scene.T_r_ck[static_cast<size_t>(o.frame)].value(), o.bearing);
			                                return !e || e->norm() > limit_rad;
		                                });
		removed += static_cast<int>(all.end() - end);
		all.erase(end, all.end());
		if (all.size() < kMinViews) point.X.reset();
	}
	return removed;
}

double rms_rad(const Scene& scene)
{
	double sum = 0;
	size_t count = 0;
	for (const ScenePoint& point : scene.points)
	{
		if (!point.X) continue;
		for (const Observation& o : point.track.observations)
		{
			const auto e = bearingError(*point.X, scene.T_r_ck[static_cast<size_t>(o.frame)].value(), o.bearing);
			sum += e ? e->squaredNorm() : M_PI * M_PI;
			count += 2;
		}
	}
	return count == 0 ? 0 : std::sqrt(sum / static_cast<double>(count));
}
}  // namespace viwo::sfm
