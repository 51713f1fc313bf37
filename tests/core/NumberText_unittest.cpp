#include <gtest/gtest.h>
#include <viwo/core/NumberText.h>

using namespace viwo;

TEST(NumberText, OneIsSingular)
{
	EXPECT_EQ(counted(0, "image"), "0 images");
	EXPECT_EQ(counted(1, "image"), "1 image");
	EXPECT_EQ(counted(21, "OXTS packet"), "21 OXTS packets");
}
