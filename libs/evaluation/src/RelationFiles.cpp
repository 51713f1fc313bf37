#include <viwo/core/Error.h>
#include <viwo/core/TimeText.h>
#include <viwo/evaluation/RelationErrors.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace viwo
{
namespace
{
constexpr size_t kWords = 8;

/** Calls read(words, where) for each line that says something. */
template <class Read>
void forEachLine(const std::string& path, char separator, const Read& read)
{
	std::ifstream file(path);
	if (!file) throw Error(path + ": cannot be read");
	std::string line;
	for (size_t number = 1; std::getline(file, line); ++number)
	{
		for (char& c : line)
			if (c == separator) c = ' ';
		std::istringstream stream(line);
		std::vector<std::string> words;
		for (std::string word; stream >> word;) words.push_back(word);
		if (words.empty() || words.front()[0] == '#') continue;
		read(words, path + ":" + std::to_string(number) + ": ");
	}
}

int64_t time_ns(const std::string& word, const std::string& where)
{
	const auto t_ns = parseSeconds(word);
	if (!t_ns) throw Error(where + "'" + word + "' is not a time in seconds");
	return *t_ns;
}

double number(const std::string& word, const std::string& where)
{
	char* end = nullptr;
	const double value = std::strtod(word.c_str(), &end);
	if (*end != '\0' || !std::isfinite(value)) throw Error(where + "'" + word + "' is not a number");
	return value;
}
}  // namespace

std::vector<Relation> loadRelations(const std::string& path)
{
	std::vector<Relation> relations;
	forEachLine(path, '\t',
	            [&](const std::vector<std::string>& words, const std::string& where)
	            {
		            if (words.size() < kWords)
			            throw Error(where + std::to_string(words.size()) + " words instead of 8 (t1 t2 x y z roll pitch yaw)");
		            double values[kWords];
		            for (size_t i = 2; i < kWords; ++i) values[i] = number(words[i], where);
		            relations.push_back({time_ns(words[0], where), time_ns(words[1], where), values[2], values[3], values[7]});
	            });
	if (relations.empty()) throw Error(path + ": holds no relation (t1 t2 x y z roll pitch yaw)");
	return relations;
}

StampTable loadStampTable(const std::string& path)
{
	StampTable table;
	bool header = false;
	forEachLine(path, ',',
	            [&](const std::vector<std::string>& words, const std::string& where)
	            {
		            if (words.size() != 2)
			            throw Error(where + std::to_string(words.size()) + " columns instead of 2 (rawlog_ns,original_s)");
		            if (!header && words[0] != "rawlog_ns") throw Error(where + "the header line rawlog_ns,original_s is missing");
		            if (header)
		            {
			            char* end = nullptr;
			            const long long t_ns = std::strtoll(words[0].c_str(), &end, 10);
			            if (*end != '\0') throw Error(where + "'" + words[0] + "' is not a time in nanoseconds");
			            table[toMicroseconds(time_ns(words[1], where))] = t_ns;
		            }
		            header = true;
	            });
	if (table.empty()) throw Error(path + ": holds no stamps");
	return table;
}
}  // namespace viwo
