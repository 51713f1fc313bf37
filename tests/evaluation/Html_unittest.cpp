#include <gtest/gtest.h>
#include <viwo/evaluation/Html.h>

#include <regex>

using namespace viwo;

namespace
{
Table someTable()
{
	Table table({{"mode", "", true}, {"ATE", "m"}});
	table.addRow({"<a>, \"b\"", "0.5"}, {1});
	table.addRow({"c", "1.5"});
	return table;
}
}  // namespace

TEST(Table, CsvQuotesWhatNeedsIt)
{
	EXPECT_EQ(someTable().toCsv(), "mode,ATE (m)\n\"<a>, \"\"b\"\"\",0.5\nc,1.5\n");
}

TEST(Table, BoldCellsStandOut)
{
	EXPECT_NE(someTable().toMarkdown().find("| **0.5** |"), std::string::npos);
	EXPECT_NE(someTable().toHtml().find("<td><b>0.5</b></td>"), std::string::npos);
	EXPECT_EQ(someTable().toText().find('*'), std::string::npos);
}

TEST(Table, LongTextsBreakAndNamesWithHyphensDoNot)
{
	Table table({{"remark", "", true}, {"ATE x-y-z", "m"}});
	table.addRow({std::string(60, 'r'), "0.5"});
	const std::string html = table.toHtml();
	EXPECT_NE(html.find("ATE <span class=\"w\">x-y-z</span>"), std::string::npos) << html;
	EXPECT_NE(html.find("<td class=\"l long\">rrr"), std::string::npos) << html;
}

TEST(HtmlPage, EscapesTextAndClosesItsTags)
{
	HtmlPage page("a < b & c");
	page.heading("1 < 2");
	page.paragraph("x > y");
	page.table(someTable(), "a \"caption\"");
	page.beginRow();
	page.figure("<svg xmlns=\"http://www.w3.org/2000/svg\"></svg>\n", "described");
	page.endRow();
	page.details("more", "k = <v>");
	const std::string html = page.toString();
	EXPECT_NE(html.find("a &lt; b &amp; c</title>"), std::string::npos);
	EXPECT_NE(html.find("k = &lt;v&gt;"), std::string::npos);
	EXPECT_NE(html.find("aria-label=\"described\""), std::string::npos);
	EXPECT_NE(html.find("name=\"viewport\""), std::string::npos);
	std::vector<std::string> open;
	const std::regex tag("<(/?)([a-z0-9]+)[^>]*>");
	for (std::sregex_iterator it(html.begin(), html.end(), tag), end; it != end; ++it)
	{
		const std::string name = (*it)[2];
		if (name == "meta" || name == "link") continue;
		if ((*it)[1].length() == 0)
			open.push_back(name);
		else
		{
			ASSERT_FALSE(open.empty()) << name;
			EXPECT_EQ(open.back(), name);
			open.pop_back();
		}
	}
	EXPECT_TRUE(open.empty());
	for (const char* word : {"<script", "@import", "url("}) EXPECT_EQ(html.find(word), std::string::npos) << word;
}

TEST(HtmlPage, WidePicturesStandAloneInTheirRow)
{
	const auto png = [](char width, char height)
	{
		const std::string three(3, '\0');
		return "\x89PNG\r\n\x1a\n" + three + "\rIHDR" + three + width + three + height;
	};
	HtmlPage square("p"), wide("p");
	square.image(png(100, 90), "image/png", "map");
	wide.image(png(100, 20), "image/png", "map");
	EXPECT_EQ(square.toString().find("<figure class"), std::string::npos);
	EXPECT_NE(wide.toString().find("<figure class=\"wide\">"), std::string::npos);
}
