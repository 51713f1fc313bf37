#include <gtest/gtest.h>
#include <viwo/core/Svg.h>

using namespace viwo;

namespace
{
const std::string kReplaced = "\xEF\xBF\xBD";
}

TEST(Svg, TextThatXmlTakes)
{
	EXPECT_EQ(escapedForXml("a<b> & \"c\"\n\t"), "a&lt;b&gt; &amp; &quot;c&quot;\n\t");
	for (const char* valid : {"Stra\xC3\x9F"
	                          "e",
	                          "\xE2\x82\xAC", "\xF0\x9F\xA4\x96"})
		EXPECT_EQ(escapedForXml(valid), valid);
}

TEST(Svg, WhatXmlForbidsIsReplaced)
{
	EXPECT_EQ(escapedForXml(std::string("a\0b\x01\x1B[1m", 8)), "a" + kReplaced + "b" + kReplaced + kReplaced + "[1m");
	EXPECT_EQ(escapedForXml("\xFC"
	                        "ber"),
	          kReplaced + "ber")
	    << "Latin-1";
	EXPECT_EQ(escapedForXml("\xC0\xAF"), kReplaced + kReplaced) << "longer than needed";
	EXPECT_EQ(escapedForXml("\xED\xA0\x80"), kReplaced + kReplaced + kReplaced) << "half of a surrogate pair";
	EXPECT_EQ(escapedForXml("\xEF\xBF\xBE"), kReplaced + kReplaced + kReplaced) << "no character";
	EXPECT_EQ(escapedForXml("\xF4\x90\x80\x80").substr(0, 3), kReplaced) << "beyond Unicode";
	EXPECT_EQ(escapedForXml("\xE2\x82"), kReplaced + kReplaced) << "cut short";
}
