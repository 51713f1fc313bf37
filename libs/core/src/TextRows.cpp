#include <viwo/core/Error.h>
#include <viwo/core/TextRows.h>
#include <viwo/core/TimeText.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace viwo
{
namespace
{
constexpr const char* kBlanks = " \t\r";
constexpr const char* kByteOrderMark = "\xEF\xBB\xBF";

std::vector<std::string> wordsOf(const std::string& line, const char* separators)
{
	std::vector<std::string> words;
	for (size_t begin = line.find_first_not_of(separators); begin != std::string::npos;)
	{
		const size_t end = std::min(line.find_first_of(separators, begin), line.size());
		words.push_back(line.substr(begin, end - begin));
		begin = line.find_first_not_of(separators, end);
	}
	return words;
}

std::vector<std::string> cellsOf(const std::string& line)
{
	std::vector<std::string> cells;
	for (size_t begin = 0; begin <= line.size();)
	{
		const size_t comma = std::min(line.find(',', begin), line.size());
		const std::string cell = line.substr(begin, comma - begin);
		const size_t first = cell.find_first_not_of(kBlanks);
		cells.push_back(first == std::string::npos ? std::string() : cell.substr(first, cell.find_last_not_of(kBlanks) + 1 - first));
		begin = comma + 1;
	}
	return cells;
}

template <class Number>
bool parse(const std::string& text, Number& value)
{
	const char* begin = text.data() + (!text.empty() && text[0] == '+' ? 1 : 0);
	const auto result = std::from_chars(begin, text.data() + text.size(), value);
	return result.ec == std::errc() && result.ptr == text.data() + text.size();
}
}  // namespace

TextRows::TextRows(const std::string& path, Split split) : path_(path), split_(split), file_(path)
{
	if (!file_ || file_.peek() == std::ifstream::traits_type::eof())
		throw Error(path + ": cannot read this file, or it is empty; check its name");
}

bool TextRows::next()
{
	for (std::string line; std::getline(file_, line);)
	{
		if (++line_ == 1 && line.rfind(kByteOrderMark, 0) == 0) line.erase(0, 3);
		const size_t first = line.find_first_not_of(kBlanks);
		if (first == std::string::npos || line[first] == '#') continue;
		words_ = split_ == Split::cells ? cellsOf(line) : wordsOf(line, split_ == Split::blanks ? kBlanks : ", \t\r");
		return true;
	}
	return false;
}

void TextRows::expectWords(size_t count, bool at_least, const std::string& meaning) const
{
	if (words_.size() == count || (at_least && words_.size() > count)) return;
	fail(std::to_string(words_.size()) + (words_.size() == 1 ? " column" : " columns") + "; expected " + (at_least ? "at least " : "") +
	     std::to_string(count) + ": " + meaning);
}

double TextRows::number(size_t word) const
{
	double value = 0;
	if (!parse(words_[word], value) || !std::isfinite(value)) fail("'" + words_[word] + "' is not a finite number");
	return value;
}

int64_t TextRows::integer(size_t word) const
{
	int64_t value = 0;
	if (!parse(words_[word], value)) fail("'" + words_[word] + "' is not a whole number");
	return value;
}

int64_t TextRows::seconds_ns(size_t word) const
{
	const auto t_ns = parseSeconds(words_[word]);
	if (!t_ns) fail("'" + words_[word] + "' is not a time in seconds");
	return *t_ns;
}

Eigen::Quaterniond TextRows::rotation(size_t w, size_t x, size_t y, size_t z) const
{
	const Eigen::Quaterniond q(number(w), number(x), number(y), number(z));
	if (std::abs(q.norm() - 1) > 0.01)
		fail("the quaternion (columns " + std::to_string(std::min(w, x) + 1) + " to " + std::to_string(std::max(w, z) + 1) +
		     ") has not unit length");
	return q.normalized();
}

std::string TextRows::where() const
{
	return path_ + ":" + std::to_string(line_);
}

void TextRows::fail(const std::string& what) const
{
	throw Error(where() + ": " + what);
}
}  // namespace viwo
