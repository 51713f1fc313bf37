#include <gtest/gtest.h>
#include <viwo/core/Error.h>
#include <viwo/experiments/Request.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace viwo::experiments
{
namespace
{
TEST(Request, SeedsAreNumbersAndRanges)
{
	EXPECT_EQ(parseSeeds("1-5"), (std::vector<uint64_t>{1, 2, 3, 4, 5}));
	EXPECT_EQ(parseSeeds("7,1-2,2"), (std::vector<uint64_t>{7, 1, 2}));
	for (const char* wrong : {"", "a", "5-1", "1-", "-3", "1,,2", "1.5", "1-99999999"}) EXPECT_THROW(parseSeeds(wrong), Error) << wrong;
}

TEST(Request, SequencesAreThePapersInItsOrder)
{
	EXPECT_EQ(parseSequences("").size(), 6u);
	EXPECT_EQ(parseSequences("seq05,seq01"), (std::vector<std::string>{"seq01", "seq05"}));
	EXPECT_THROW(parseSequences("seq07"), Error);
	EXPECT_EQ(parseTables("3,1"), (std::set<int>{1, 3}));
	EXPECT_THROW(parseTables("4"), Error);
	EXPECT_THROW(parseTables(""), Error);
}

TEST(Request, Median)
{
	EXPECT_EQ(median({3, 1, 2}), 2);
	EXPECT_EQ(median({4, 1, 2, 3}), 2.5);
	EXPECT_EQ(median({1, 2, std::numeric_limits<double>::infinity()}), 2) << "one failure of three does not decide";
	EXPECT_TRUE(std::isnan(median({})));
	EXPECT_TRUE(std::isnan(median({1, std::nan("")})));
}

/** The paper's averages against its entries: catches slips of copying (it rounds to 0.01; two of its averages are off by more itself). */
TEST(Paper, AveragesAreThoseOfTheEntries)
{
	ASSERT_EQ(paperSequences().size(), 6u);
	int deviating = 0;
	for (const PaperSequence& sequence : paperSequences())
		for (const PaperRow* row : {&sequence.vins_time_s, &sequence.own_time_s, &sequence.vins_rmse_m, &sequence.own_rmse_m})
		{
			ASSERT_EQ(row->values.size(), sequence.starts_s.size()) << sequence.name;
			double sum = 0, count = 0;
			for (const double value : row->values)
				if (!std::isnan(value)) sum += value, ++count;
			if (std::abs(sum / count - row->average) > 0.0151) ++deviating;
			EXPECT_NEAR(sum / count, row->average, 0.06) << sequence.name;
		}
	std::cout << "[measured] printed averages that differ from their entries by more than rounding: " << deviating << "\n";
	for (const PaperSequence& sequence : paperSequences())
		for (const PaperAte& ate : {sequence.vio, sequence.wheel, sequence.viwo})
			EXPECT_NEAR(std::hypot(ate.xy_m, ate.z_m), ate.xyz_m, 0.08) << sequence.name;
}

TEST(Paper, SequencesAreLongEnoughForTheirStarts)
{
	for (const PaperSequence& sequence : paperSequences())
		EXPECT_GT(sequenceDuration_s(sequence.name), sequence.starts_s.back() + 40) << sequence.name;
}
}  // namespace
}  // namespace viwo::experiments
