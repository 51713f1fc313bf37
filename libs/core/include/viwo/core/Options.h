#pragma once

#include <mrpt/config/CConfigFileBase.h>
#include <mrpt/config/CLoadableOptions.h>

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

/** Options of a part of the program, each field named once.
 *  @code
 *  struct TrackerOptions : Options<TrackerOptions>
 *  {
 *      int max_features = 150;  // ...
 *      template <class Visitor> void visit(Visitor& v)
 *      {
 *          v("max_features", max_features, "corners tracked at a time", 10, 2000);
 *      }
 *  };
 *  @endcode
 *  From that one list come loading (strict: a malformed value, one out of range, or a key that is not listed is an Error that names
 *  file, section and key), saving with comments, and validation. @file
 */
namespace viwo
{
/** Strict reader of one INI section; used by Options. */
class OptionsReader
{
   public:
	/** The source is named in messages. */
	OptionsReader(const mrpt::config::CConfigFileBase& source, std::string section);

	void operator()(const char* key, double& value, const char* comment, double min = -std::numeric_limits<double>::infinity(),
	                double max = std::numeric_limits<double>::infinity());
	void operator()(const char* key, int& value, const char* comment, int min = std::numeric_limits<int>::min(),
	                int max = std::numeric_limits<int>::max());
	void operator()(const char* key, bool& value, const char* comment);
	void operator()(const char* key, std::string& value, const char* comment);
	/** Space-separated numbers, any count. */
	void operator()(const char* key, std::vector<double>& value, const char* comment);

	/** One of a fixed list of words; the index into `words` is stored. */
	template <class Enum>
	void choice(const char* key, Enum& value, const char* comment, const std::vector<std::string>& words)
	{
		int index = static_cast<int>(value);
		readChoice(key, index, words);
		value = static_cast<Enum>(index);
		(void)comment;
	}

	/** @throws Error for the first key of the section that no call above has named, suggesting the nearest one that was. */
	void rejectUnknownKeys() const;

   private:
	bool raw(const char* key, std::string& text);
	[[noreturn]] void fail(const char* key, const std::string& text, const std::string& expected) const;
	void readChoice(const char* key, int& index, const std::vector<std::string>& words);

	const mrpt::config::CConfigFileBase& source_;
	std::string section_;
	std::vector<std::string> known_keys_;
};

/** Writes the same fields with their comments. */
class OptionsWriter
{
   public:
	OptionsWriter(mrpt::config::CConfigFileBase& target, std::string section) : target_(target), section_(std::move(section)) {}

	void operator()(const char* key, double value, const char* comment, double = 0, double = 0);
	void operator()(const char* key, int value, const char* comment, int = 0, int = 0);
	void operator()(const char* key, bool value, const char* comment);
	void operator()(const char* key, const std::string& value, const char* comment);
	void operator()(const char* key, const std::vector<double>& value, const char* comment);

	template <class Enum>
	void choice(const char* key, Enum value, const char* comment, const std::vector<std::string>& words)
	{
		writeChoice(key, static_cast<size_t>(value), comment, words);
	}

   private:
	void writeChoice(const char* key, size_t index, const char* comment, const std::vector<std::string>& words);

	mrpt::config::CConfigFileBase& target_;
	std::string section_;
};
/** Base of a struct of options that lists them in visit(); see the head of this file. */
template <class Derived>
class Options : public mrpt::config::CLoadableOptions
{
   public:
	/** @throws Error that names section and key. Keys that are absent keep their value. */
	void loadFromConfigFile(const mrpt::config::CConfigFileBase& source, const std::string& section) override
	{
		OptionsReader reader(source, section);
		static_cast<Derived&>(*this).visit(reader);
		reader.rejectUnknownKeys();
	}

	void saveToConfigFile(mrpt::config::CConfigFileBase& target, const std::string& section) const override
	{
		OptionsWriter writer(target, section);
		// visit() takes references so that one list serves both ways; the writer changes nothing.
		const_cast<Derived&>(static_cast<const Derived&>(*this)).visit(writer);
	}
};

/** One named section of a configuration file. */
struct OptionsSection
{
	std::string name;
	mrpt::config::CLoadableOptions* options;
};

/** Loads every section that the file has into its options.
 *  @throws Error, starting with the file's name: unreadable file, unknown section, duplicate key in a section, or any error of Options.
 */
void loadOptions(const std::string& ini_path, const std::vector<OptionsSection>& sections);

/** Writes all sections with comments; the file can be read back by loadOptions(). @throws Error when it cannot be written. */
void saveOptions(const std::string& ini_path, const std::vector<OptionsSection>& sections, const std::string& header_comment = {});
}  // namespace viwo
