#include <mrpt/system/string_utils.h>
#include <viwo/core/Svg.h>
#include <viwo/evaluation/Html.h>

#include <algorithm>

namespace viwo
{
namespace
{
constexpr const char* kStyle = R"(
:root { color-scheme: light dark; --paper: #ffffff; --ink: #202124; --muted: #5f6368; --grid: #e3e6ea; --reference: #9aa0a6; --band: #f5f6f8;
  --c1: #0072b2; --c2: #d55e00; --c3: #009e73; --c4: #cc79a7; --c5: #b07a00; --c6: #3a8fc0; }
@media (prefers-color-scheme: dark) { :root { --paper: #16181b; --ink: #e8eaed; --muted: #a4a9af; --grid: #33373c; --reference: #80868b; --band: #1f2226;
  --c1: #5ab4f0; --c2: #ff8a4c; --c3: #3fcf9f; --c4: #e79cc8; --c5: #f0bc4a; --c6: #8cd0f5; } }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 1rem; max-width: 76rem; background: var(--paper); color: var(--ink); font: 16px/1.5 Helvetica, Arial, sans-serif; overflow-wrap: break-word; }
h1 { font-size: 1.6rem; margin: 0.5rem 0; }
h2 { font-size: 1.25rem; margin: 2rem 0 0.5rem; border-bottom: 1px solid var(--grid); }
h3 { font-size: 1rem; margin: 1.5rem 0 0.5rem; }
p { max-width: 48rem; } a { color: var(--c1); }
.scroll { overflow-x: auto; margin: 0.5rem 0; }
table { border-collapse: collapse; font-size: 0.9rem; font-variant-numeric: tabular-nums; }
.caption { margin: 0 0 1rem; color: var(--muted); font-size: 0.85rem; }
th, td { padding: 0.25rem 0.6rem; text-align: right; white-space: nowrap; }
th { min-width: 4rem; border-bottom: 2px solid var(--reference); vertical-align: bottom; white-space: normal; } th small { display: block; color: var(--muted); font-weight: normal; }
td { border-bottom: 1px solid var(--grid); } .l { text-align: left; } .w { white-space: nowrap; }
.long { white-space: normal; min-width: 16rem; overflow-wrap: anywhere; }
tbody tr:hover { background: var(--band); } b { color: var(--c3); }
figure { margin: 0.5rem 0 1rem; min-width: 0; } figure svg { max-width: 100%; min-width: 22rem; height: auto; display: block; }
figure img { max-width: 100%; height: auto; display: block; background: #ffffff; }
figcaption { color: var(--muted); font-size: 0.85rem; }
.row { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 30rem), 1fr)); gap: 0 1rem; align-items: start; }
.row > .tall { grid-row: span 2; } .row > .wide { grid-column: 1 / -1; }
details { margin: 1rem 0; } summary { cursor: pointer; } pre { overflow-x: auto; background: var(--band); padding: 0.6rem; font-size: 0.8rem; }
@media (max-width: 40rem) { table { font-size: 0.75rem; } th, td { padding: 0.2rem 0.25rem; white-space: normal; } th { min-width: 0; } .long { min-width: 6rem; } }
@media print { :root { --paper: #ffffff; --ink: #000000; --muted: #444444; --grid: #dddddd; --reference: #888888; --band: #ffffff;
  --c1: #0072b2; --c2: #d55e00; --c3: #009e73; --c4: #cc79a7; --c5: #b07a00; --c6: #3a8fc0; }
  :root { font-size: 10px; } body { max-width: none; padding: 0; font-size: 10px; } p { max-width: none; } .scroll { overflow: visible; }
  figure svg { min-width: 0; } figure, tr { break-inside: avoid; } h2, h3 { break-after: avoid; } th, td { padding: 0.1rem 0.3rem; } th { min-width: 0; } }
)";

/** Whether a PNG is so much wider than high that it needs the page's width: its size is in bytes 16 to 23. */
bool isWidePng(const std::string& bytes)
{
	constexpr double kWide = 2.2;
	if (bytes.size() < 24 || bytes.compare(1, 3, "PNG") != 0) return false;
	const auto number = [&](size_t at)
	{
		double value = 0;
		for (size_t i = at; i < at + 4; ++i) value = 256 * value + static_cast<unsigned char>(bytes[i]);
		return value;
	};
	return number(16) > kWide * number(20);
}
}  // namespace

void HtmlPage::subheading(const std::string& text)
{
	body_ += "<h3>" + escapedForXml(text) + "</h3>\n";
}

void HtmlPage::heading(const std::string& text)
{
	body_ += "<h2>" + escapedForXml(text) + "</h2>\n";
}

void HtmlPage::paragraph(const std::string& text)
{
	body_ += "<p>" + escapedForXml(text) + "</p>\n";
}

void HtmlPage::table(const Table& table, const std::string& caption)
{
	// The caption stays where it is while a wide table scrolls.
	body_ += "<div class=\"scroll\" tabindex=\"0\">\n" + table.toHtml() + "</div>\n";
	if (!caption.empty()) body_ += "<p class=\"caption\">" + escapedForXml(caption) + "</p>\n";
}

void HtmlPage::figure(const std::string& svg, const std::string& caption, bool tall)
{
	std::string picture = svg;
	const std::string tag = "<svg ";
	if (picture.compare(0, tag.size(), tag) == 0) picture.insert(tag.size(), "role=\"img\" aria-label=\"" + escapedForXml(caption) + "\" ");
	body_ += std::string("<figure") + (tall ? " class=\"tall\"" : "") + ">\n<div class=\"scroll\" tabindex=\"0\">\n" + picture +
	         "</div>\n<figcaption>" + escapedForXml(caption) + "</figcaption>\n</figure>\n";
}

void HtmlPage::image(const std::string& bytes, const std::string& type, const std::string& caption)
{
	std::string text;
	mrpt::system::encodeBase64({bytes.begin(), bytes.end()}, text);
	text.erase(std::remove(text.begin(), text.end(), '\n'), text.end());
	const std::string said = escapedForXml(caption);
	body_ += std::string("<figure") + (isWidePng(bytes) ? " class=\"wide\"" : "") + ">\n<img alt=\"" + said + "\" src=\"data:" + type +
	         ";base64," + text + "\">\n<figcaption>" + said + "</figcaption>\n</figure>\n";
}

void HtmlPage::beginRow()
{
	body_ += "<div class=\"row\">\n";
}

void HtmlPage::endRow()
{
	body_ += "</div>\n";
}

void HtmlPage::details(const std::string& title, const std::string& text)
{
	body_ += "<details><summary>" + escapedForXml(title) + "</summary>\n<pre>" + escapedForXml(text) + "</pre>\n</details>\n";
}

std::string HtmlPage::toString() const
{
	const std::string title = escapedForXml(title_);
	return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width, "
	       "initial-scale=1\">\n"
	       "<link rel=\"icon\" href=\"data:,\">\n<title>" +
	       title + "</title>\n<style>" + kStyle + "</style>\n</head>\n<body>\n<h1>" + title + "</h1>\n" + body_ + "</body>\n</html>\n";
}
}  // namespace viwo
