#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <viwo/core/Options.h>

#include "ExpectError.h"
#include "TempFolder.h"

using namespace viwo;
using viwo::testing::expectError;
using viwo::testing::readFile;
using viwo::testing::TempFolder;
using viwo::testing::writeFile;

namespace
{
enum class Fruit
{
	apple,
	pear
};

struct BasketOptions : Options<BasketOptions>
{
	int count = 3;
	double weight_kg = 0.1;
	bool is_ripe = true;
	std::string label = "CAM";
	std::vector<double> sizes_m{0.1, 1e-9};
	Fruit fruit = Fruit::pear;

	template <class Visitor>
	void visit(Visitor& v)
	{
		v("count", count, "pieces", 0, 100);
		v("weight_kg", weight_kg, "of one", 0.0);
		v("is_ripe", is_ripe, "eat now");
		v("label", label, "on the basket");
		v("sizes_m", sizes_m, "of each");
		v.choice("fruit", fruit, "kind", {"apple", "pear"});
	}
};

struct OtherOptions : Options<OtherOptions>
{
	double x = 0;
	template <class Visitor>
	void visit(Visitor& v)
	{
		v("x", x, "");
	}
};

class OptionsFile : public ::testing::Test
{
   protected:
	void load(const std::string& content)
	{
		writeFile(path, content);
		loadOptions(path, {{"basket", &basket}, {"other", &other}});
	}
	void expectBad(const std::string& content, std::initializer_list<std::string> parts)
	{
		expectError([&] { load(content); }, parts);
	}

	TempFolder folder;
	std::string path = folder.file("c.ini");
	BasketOptions basket;
	OtherOptions other;
};
}  // namespace

TEST_F(OptionsFile, LoadsEveryType)
{
	load(
	    "# comment\n; comment\n// comment\n[other]\nx = -1.5e3\n\n[basket]\ncount=7   // inline\nweight_kg = +.25\nis_ripe = No\nlabel = a "
	    "b // c\nsizes_m = 1 2\t3e-1\nfruit = Apple\n");
	EXPECT_EQ(other.x, -1500);
	EXPECT_EQ(basket.count, 7);
	EXPECT_EQ(basket.weight_kg, 0.25);
	EXPECT_FALSE(basket.is_ripe);
	EXPECT_EQ(basket.label, "a b");
	EXPECT_EQ(basket.sizes_m, (std::vector<double>{1, 2, 0.3}));
	EXPECT_EQ(basket.fruit, Fruit::apple);
}

TEST_F(OptionsFile, AbsentKeysAndSectionsKeepTheirValues)
{
	load("");
	EXPECT_EQ(basket.weight_kg, 0.1);
	load("[basket]\ncount = 4\n");
	EXPECT_EQ(basket.count, 4);
	EXPECT_EQ(basket.weight_kg, 0.1);
	EXPECT_EQ(basket.fruit, Fruit::pear);
	EXPECT_EQ(other.x, 0);
}

TEST_F(OptionsFile, CaseAndWindowsLineEndsDoNotMatter)
{
	load("\xEF\xBB\xBF[Basket]\r\nCount = 9\r\nlabel = IMU\r\n");
	EXPECT_EQ(basket.count, 9);
	EXPECT_EQ(basket.label, "IMU");
}

TEST_F(OptionsFile, MalformedValuesAreErrors)
{
	expectBad("[basket]\ncount = abc\n", {path, "[basket]", "count", "abc", "whole number"});
	expectBad("[basket]\ncount = 3.5\n", {path, "[basket]", "count", "3.5"});
	expectBad("[basket]\ncount = 12x\n", {"count", "12x"});
	expectBad("[basket]\ncount = 99999999999\n", {"count"});
	expectBad("[basket]\ncount =\n", {"count"});
	expectBad("[basket]\nweight_kg = 1,5\n", {"weight_kg", "1,5"});
	expectBad("[basket]\nweight_kg = nan\n", {"weight_kg", "nan"});
	expectBad("[basket]\nweight_kg = inf\n", {"weight_kg", "inf"});
	expectBad("[basket]\nweight_kg = +-1\n", {"weight_kg"});
	expectBad("[basket]\nis_ripe = maybe\n", {"is_ripe", "maybe", "true or false"});
	expectBad("[basket]\nsizes_m = 1 two 3\n", {"sizes_m", "two"});
	expectBad("[basket]\nfruit = appel\n", {"fruit", "apple, pear", "did you mean 'apple'"});
}

TEST_F(OptionsFile, OutOfRangeNamesTheRange)
{
	expectBad("[basket]\ncount = 101\n", {path, "[basket]", "count", "from 0 to 100"});
	expectBad("[basket]\ncount = -1\n", {"count", "from 0 to 100"});
	expectBad("[basket]\nweight_kg = -0.1\n", {"weight_kg", "at least 0"});
}

TEST_F(OptionsFile, MistypedNamesAreErrorsWithASuggestion)
{
	expectBad("[basket]\ncuont = 4\n", {path, "[basket]", "cuont", "did you mean 'count'"});
	expectBad("[baskets]\ncount = 4\n", {path, "[baskets]", "did you mean 'basket'"});
	expectBad("[basket]\nzzzzzzzzzzzz = 4\n", {"zzzzzzzzzzzz", "unknown key"});
}

TEST_F(OptionsFile, WhatTheParserSkipsInSilenceIsAnError)
{
	expectBad("[basket]\ncount = 4\n\nCount = 5\n", {path + ":4", "[basket]", "Count", "twice"});
	expectBad("[basket]\ncount = 4\n[other]\n[basket]\ncount = 5\n", {path + ":5", "twice"});
	expectBad("[basket]\ncount 4\n", {path + ":2", "count 4"});
	expectBad("count = 4\n[basket]\n", {path + ":1", "before"});
	expectBad("[basket\ncount = 4\n", {path + ":1", "]"});
	expectBad(std::string("\x1f\x8b\x00\x01", 4), {path, "no text"});
}

TEST_F(OptionsFile, UnreadableFile)
{
	expectError([&] { loadOptions(folder.file("none.ini"), {{"basket", &basket}}); }, {folder.file("none.ini"), "cannot read"});
	expectError([&] { loadOptions(folder.path(), {{"basket", &basket}}); }, {folder.path(), "cannot read"});
}

TEST_F(OptionsFile, SavedFileReadsBackAndSavesAsTheSameBytes)
{
	basket.count = 42;
	basket.weight_kg = 1. / 3;
	basket.is_ripe = false;
	basket.label = "";
	basket.sizes_m = {1e-300, 12345678.9012345};
	basket.fruit = Fruit::apple;
	other.x = 0.1 + 0.2;
	saveOptions(path, {{"basket", &basket}, {"other", &other}}, "line one\nline two");
	const std::string text = readFile(path);
	EXPECT_EQ(text.rfind("# line one\n# line two\n", 0), 0u) << text;
	EXPECT_NE(text.find("pieces"), std::string::npos) << text;
	EXPECT_NE(text.find("on the basket"), std::string::npos) << "a key without a value has its comment too";

	BasketOptions basket2;
	OtherOptions other2;
	loadOptions(path, {{"basket", &basket2}, {"other", &other2}});
	EXPECT_EQ(basket2.count, 42);
	EXPECT_EQ(basket2.weight_kg, 1. / 3);
	EXPECT_FALSE(basket2.is_ripe);
	EXPECT_EQ(basket2.label, "");
	EXPECT_EQ(basket2.sizes_m, basket.sizes_m);
	EXPECT_EQ(basket2.fruit, Fruit::apple);
	EXPECT_EQ(other2.x, 0.1 + 0.2);
	saveOptions(folder.file("again.ini"), {{"basket", &basket2}, {"other", &other2}}, "line one\nline two");
	EXPECT_EQ(readFile(folder.file("again.ini")), text);
}

TEST_F(OptionsFile, KeysStayInTheOrderOfTheirFields)
{
	saveOptions(path, {{"other", &other}, {"basket", &basket}});
	const std::string text = readFile(path);
	size_t last = 0;
	for (const char* word : {"[other]", "x =", "[basket]", "count =", "weight_kg =", "is_ripe =", "label =", "sizes_m =", "fruit ="})
	{
		const size_t at = text.find(word);
		ASSERT_NE(at, std::string::npos) << word << " is not in\n" << text;
		EXPECT_GT(at + 1, last) << word;
		last = at;
	}
}

TEST(Options, AnyMrptConfigurationServes)
{
	const mrpt::config::CConfigFileMemory source(std::string("[a]\ncount = 8\n[b]\nconut = 8\n"));
	BasketOptions basket;
	basket.loadFromConfigFile(source, "a");
	EXPECT_EQ(basket.count, 8);
	expectError([&] { basket.loadFromConfigFile(source, "b"); }, {"[b]", "conut", "count"});
}
