#pragma once

#include <viwo/evaluation/Table.h>

#include <string>

namespace viwo
{
/** A page in one file: no script, nothing from the network; light or dark as the reader's screen, readable on a phone and printed. */
class HtmlPage
{
   public:
	explicit HtmlPage(std::string title) : title_(std::move(title)) {}

	void heading(const std::string& text);
	void subheading(const std::string& text);
	void paragraph(const std::string& text);
	/** Scrolls sideways by itself where the screen is too narrow. */
	void table(const Table& table, const std::string& caption);
	/** SVG text in the page's colours (PlotColours::page), with a description for who cannot see it.
	 *  @param tall in a row: two figures stand one above the other beside it. */
	void figure(const std::string& svg, const std::string& caption, bool tall = false);
	/** A picture, inside of the page; in a row, one that is much wider than high stands alone. @param bytes of its file. @param type e.g.
	 * "image/png". */
	void image(const std::string& bytes, const std::string& type, const std::string& caption);
	/** Figures after this stand side by side where there is room, until the next endRow(). */
	void beginRow();
	void endRow();
	/** Text as it is, folded away under its title. */
	void details(const std::string& title, const std::string& text);

	std::string toString() const;

   private:
	std::string title_, body_;
};
}  // namespace viwo
