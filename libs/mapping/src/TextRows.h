#pragma once

#include <fstream>
#include <string>
#include <vector>

namespace viwo
{
/** Lines of words, split at blanks or commas; blank lines and '#' lines are skipped. */
class TextRows
{
   public:
	/** @throws Error when the file cannot be read, or is empty. */
	TextRows(const std::string& path, const std::string& separators);

	bool next();

	const std::vector<std::string>& words() const { return words_; }

	/** @throws Error unless the row has this many words, or more where `at_least`. */
	void expectWords(size_t count, bool at_least, const std::string& meaning) const;

	/** @throws Error for a word that is not a finite number. */
	double number(size_t word) const;

	/** @throws Error that names file and line. */
	[[noreturn]] void fail(const std::string& what) const;

   private:
	std::string path_, separators_;
	std::ifstream file_;
	int line_ = 0;
	std::vector<std::string> words_;
};
}  // namespace viwo
