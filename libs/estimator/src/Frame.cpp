#include "Frame.h"

#include "residuals/BlockAlgebra.h"

namespace viwo
{
NavState Frame::state() const
{
	NavState s;
	s.t_ns = t_ns;
	s.T_WB = poseFromBlock(pose.data());
	s.v_WB = Eigen::Map<const Eigen::Vector3d>(&motion[0]);
	s.b_a = Eigen::Map<const Eigen::Vector3d>(&motion[3]);
	s.b_g = Eigen::Map<const Eigen::Vector3d>(&motion[6]);
	return s;
}

void Frame::setState(const NavState& state)
{
	poseToBlock(state.T_WB, pose.data());
	Eigen::Map<Eigen::Vector3d>{&motion[0]} = state.v_WB;
	Eigen::Map<Eigen::Vector3d>{&motion[3]} = state.b_a;
	Eigen::Map<Eigen::Vector3d>{&motion[6]} = state.b_g;
}
}  // namespace viwo
