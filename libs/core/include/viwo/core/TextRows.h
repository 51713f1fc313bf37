#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

namespace viwo
{
/** Lines of words of a text file; blank lines and '#' lines are skipped. Line ends may be those of Windows, and the file may begin with
 *  UTF-8's byte order mark, as its editors write it.
 */
class TextRows
{
   public:
	enum class Split
	{
		blanks,             //!< any number of blanks between two words
		commas_and_blanks,  //!< any number of either
		cells               //!< a comma between two cells, which may be empty; blanks around them do not count
	};

	/** @throws Error when the file cannot be read, or is empty. */
	TextRows(const std::string& path, Split split);

	bool next();

	const std::vector<std::string>& words() const { return words_; }

	/** @throws Error unless the row has this many words, or more where `at_least`. */
	void expectWords(size_t count, bool at_least, const std::string& meaning) const;

	/** @throws Error for a word that is not a finite number. */
	double number(size_t word) const;

	/** @throws Error for a word that is not a whole number. */
	int64_t integer(size_t word) const;

	/** Of a word that is a time in seconds, ns. @throws Error for any other. */
	int64_t seconds_ns(size_t word) const;

	/** Of the words that are its parts. @throws Error unless it has unit length, within 1 %. */
	Eigen::Quaterniond rotation(size_t w, size_t x, size_t y, size_t z) const;

	/** "file:line". */
	std::string where() const;

	/** @throws Error that names file and line. */
	[[noreturn]] void fail(const std::string& what) const;

   private:
	std::string path_;
	Split split_;
	std::ifstream file_;
	int line_ = 0;
	std::vector<std::string> words_;
};
}  // namespace viwo
