// Another project's program: uses viwo as installed.
#include <viwo/evaluation/TrajectoryErrors.h>

int main()
{
	viwo::Trajectory drive;
	for (int i = 0; i < 5; ++i) drive.push_back({i * 100000000, viwo::Pose3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.1 * i, 0, 0))});
	return viwo::evaluate(drive, drive, {}).ate_xyz_m < 1e-9 ? 0 : 1;
}
