#include "TextRows.h"

#include <viwo/core/Error.h>

#include <charconv>
#include <cmath>

namespace viwo
{
TextRows::TextRows(const std::string& path, const std::string& separators) : path_(path), separators_(separators), file_(path)
{
	if (!file_ || file_.peek() == std::ifstream::traits_type::eof())
		throw Error(path + ": cannot read this file, or it is empty; check its name");
}

bool TextRows::next()
{
	for (std::string line; std::getline(file_, line);)
	{
		++line_;
		while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
		const size_t first = line.find_first_not_of(" \t");
		if (first == std::string::npos || line[first] == '#') continue;
		words_.clear();
		for (size_t begin = line.find_first_not_of(separators_); begin != std::string::npos;)
		{
			const size_t end = std::min(line.find_first_of(separators_, begin), line.size());
			words_.push_back(line.substr(begin, end - begin));
			begin = line.find_first_not_of(separators_, end);
		}
		return true;
	}
	return false;
}

void TextRows::expectWords(size_t count, bool at_least, const std::string& meaning) const
{
	if (words_.size() == count || (at_least && words_.size() > count)) return;
	fail(std::to_string(words_.size()) + " columns; expected " + std::to_string(count) + ": " + meaning);
}

double TextRows::number(size_t word) const
{
	const std::string& text = words_[word];
	const char* begin = text.data() + (text[0] == '+' ? 1 : 0);
	double value = 0;
	const auto result = std::from_chars(begin, text.data() + text.size(), value);
	if (result.ec != std::errc() || result.ptr != text.data() + text.size() || !std::isfinite(value))
		fail("'" + text + "' is not a finite number");
	return value;
}

void TextRows::fail(const std::string& what) const
{
	throw Error(path_ + ":" + std::to_string(line_) + ": " + what);
}
}  // namespace viwo
