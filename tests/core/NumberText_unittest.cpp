#include <gtest/gtest.h>
#include <viwo/core/NumberText.h>

#include <cmath>

using namespace viwo;

TEST(NumberText, OneIsSingular)
{
	EXPECT_EQ(counted(0, "image"), "0 images");
	EXPECT_EQ(counted(1, "image"), "1 image");
	EXPECT_EQ(counted(21, "OXTS packet"), "21 OXTS packets");
}

TEST(NumberText, DecimalsAndDigits)
{
	EXPECT_EQ(fixed(2.0 / 3, 2), "0.67");
	EXPECT_EQ(fixed(std::nan(""), 2), "-");
	EXPECT_EQ(fixed(-1e300, 9).size(), 1u + 301 + 1 + 9) << "cut";
	EXPECT_EQ(significant(0.012345, 3), "0.0123");
	EXPECT_EQ(significant(200, 3), "200");
	EXPECT_EQ(significant(1.5e-7, 4), "1.5e-07");
}
