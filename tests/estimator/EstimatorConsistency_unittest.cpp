#include <NormalisedError.h>
#include <SimulatedDrive.h>
#include <gtest/gtest.h>

namespace viwo
{
namespace
{
using test::Drive;
using test::DriveSetup;
using test::measured;
using test::optionsOf;

TEST(EstimatorConsistency, CovarianceTellsTheErrors)
{
	for (const Mode mode : {Mode::wio, Mode::viwo})
	{
		double sum = 0;
		int count = 0;
		const int runs = test::seedsOf(10);
		for (int seed = 1; seed <= runs; ++seed)
		{
			DriveSetup setup(seed % 2 ? "straight 1 m, rotate 90 deg" : "arc 0.8 m 90 deg", seed);
			test::drawWheels(setup);
			const Drive drive(setup);
			const test::DriveResult result = runDrive(drive, optionsOf(mode));
			const auto [of_run, of_run_count] = test::normalisedErrors(drive, result, 2);
			sum += of_run;
			count += of_run_count;
		}
		measured("ANEES of position and yaw per degree of freedom, " + std::to_string(runs) + " runs, mode " +
		             modeNames()[static_cast<size_t>(mode)],
		         sum / count, "");
		EXPECT_GT(sum / count, 0.3);
		EXPECT_LT(sum / count, 3);
	}
}
}  // namespace
}  // namespace viwo
