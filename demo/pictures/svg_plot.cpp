#include "demo/pictures/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <span>
#include <string_view>
#include <utility>

namespace mobil {
namespace {

constexpr std::string_view ink = "#333", faint = "#8a8a8a", grid = "#ececec";
constexpr double margin = 12, title_height = 26, legend_height = 20, panel_title_height = 18, tick_height = 16,
                 axis_label_height = 16, y_label_width = 18, y_tick_width = 36, gap = 22, footnote_height = 18,
                 swatch_width = 18;

/// Estimates the width of a text at the default size, pixels. UTF-8 continuation bytes have no width.
double text_width(std::string_view text) {
  return 6.1 * static_cast<double>(std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string escaped(std::string_view text) {
  constexpr std::string_view marks = "&<>\"", names[] = {"&amp;", "&lt;", "&gt;", "&quot;"};
  std::string out;
  for (const char c : text) {
    const std::size_t mark = marks.find(c);
    out += mark == std::string_view::npos ? std::string(1, c) : std::string(names[mark]);
  }
  return out;
}

/// A range that is extended by values.
struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  bool logarithmic = false;

  bool shows(double value) const { return std::isfinite(value) && (!logarithmic || value > 0); }
  void include(double value) {
    if (!shows(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void include(const std::vector<double>& values) {
    for (const double value : values) include(value);
  }
  double scaled(double value) const { return logarithmic ? std::log10(value) : value; }
};

/// Returns a range that is not empty, with a margin `air` around the data. Fixed ends are kept.
Range settled(Range range, const PlotAxis& axis, double air) {
  if (!(range.low <= range.high)) range.low = range.high = 1;
  if (range.low == range.high) {
    const double half = range.logarithmic ? 0 : std::max(std::abs(range.low) * 0.1, 1e-9);
    range.low = range.logarithmic ? range.low / 2 : range.low - half;
    range.high = range.logarithmic ? range.high * 2 : range.high + half;
  }
  const double width = air * (range.scaled(range.high) - range.scaled(range.low));
  if (range.logarithmic) {
    range.low *= std::pow(10, -width);
    range.high *= std::pow(10, width);
  } else {
    range.low -= width;
    range.high += width;
  }
  if (axis.low && range.shows(*axis.low)) range.low = *axis.low;
  if (axis.high && range.shows(*axis.high)) range.high = *axis.high;
  return range;
}

void include_x(const PlotPanel& panel, Range& range) {
  for (const auto& band : panel.bands) range.include(band.x);
  for (const auto& line : panel.lines) range.include(line.x);
  for (const auto& points : panel.points) range.include(points.x);
}

void include_y(const PlotPanel& panel, Range& range) {
  for (const auto& band : panel.bands) {
    range.include(band.low);
    range.include(band.high);
  }
  for (const auto& line : panel.lines) range.include(line.y);
  for (const auto& points : panel.points) range.include(points.y);
}

/// A panel's place on the page, and the mapping from data to pixels.
struct Frame {
  double left, top, width, height;
  Range x, y;

  double at_x(double value) const {
    return left + width * (x.scaled(value) - x.scaled(x.low)) / (x.scaled(x.high) - x.scaled(x.low));
  }
  double at_y(double value) const {
    return top + height * (1 - (y.scaled(value) - y.scaled(y.low)) / (y.scaled(y.high) - y.scaled(y.low)));
  }
  bool shows(double x_value, double y_value) const { return x.shows(x_value) && y.shows(y_value); }
};

struct Page {
  std::string body;

  template <class... Values>
  void add(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(body), format, std::forward<Values>(values)...);
    body += '\n';
  }
  void text(double x, double y, std::string_view anchor, std::string_view what, std::string_view colour = ink,
            double size = 11, bool bold = false) {
    add(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="{}" fill="{}" font-size="{}"{}>{}</text>)", x, y, anchor, colour,
        size, bold ? R"( font-weight="600")" : "", escaped(what));
  }
};

/// Returns the label of a tick, as short as possible.
std::string tick_text(double value, bool logarithmic) {
  if (logarithmic && value != 0 && (std::abs(value) >= 1e5 || std::abs(value) < 1e-3)) {
    return fmt::format("{:.0e}", value);
  }
  return fmt::format("{:.6g}", std::abs(value) < 1e-12 ? 0 : value);
}

void draw_axes(Page& page, const PlotPanel& panel, const Frame& frame, bool with_y) {
  const double right = frame.left + frame.width, bottom = frame.top + frame.height;
  for (const double tick : plot_ticks(frame.x.low, frame.x.high, frame.x.logarithmic)) {
    const double x = frame.at_x(tick);
    page.add(R"(<path d="M{0:.1f} {1:.1f}V{2:.1f}" stroke="{3}"/>)", x, frame.top, bottom, grid);
    page.text(x, bottom + 13, "middle", tick_text(tick, frame.x.logarithmic), faint, 10);
  }
  for (const double tick : plot_ticks(frame.y.low, frame.y.high, frame.y.logarithmic)) {
    const double y = frame.at_y(tick);
    const bool zero = tick == 0 && frame.y.low < 0;
    page.add(R"(<path d="M{0:.1f} {1:.1f}H{2:.1f}" stroke="{3}"/>)", frame.left, y, right,
             zero ? std::string_view("#c4c4c4") : grid);
    if (with_y) page.text(frame.left - 5, y + 3.5, "end", tick_text(tick, frame.y.logarithmic), faint, 10);
  }
  if (!panel.title.empty()) page.text(frame.left, frame.top - 6, "start", panel.title, ink, 11.5, true);
  if (!panel.x.label.empty()) {
    page.text(frame.left + frame.width / 2, bottom + tick_height + 11, "middle", panel.x.label, ink);
  }
  if (with_y && !panel.y.label.empty()) {
    const double x = frame.left - y_tick_width - 5, y = frame.top + frame.height / 2;
    page.add(
        R"svg(<text x="{0:.1f}" y="{1:.1f}" text-anchor="middle" fill="{2}" transform="rotate(-90 {0:.1f} {1:.1f})">{3}</text>)svg",
        x, y, ink, escaped(panel.y.label));
  }
}

void draw_band(Page& page, const PlotBand& band, const Frame& frame) {
  const std::size_t count = std::min({band.x.size(), band.low.size(), band.high.size()});
  const auto shown = [&](std::size_t i) { return frame.shows(band.x[i], band.low[i]) && frame.y.shows(band.high[i]); };
  std::string path;
  for (std::size_t first = 0; first < count;) {
    if (!shown(first)) {
      ++first;
      continue;
    }
    std::size_t end = first;
    char command = 'M';
    for (; end < count && shown(end); ++end, command = 'L') {
      path += fmt::format("{}{:.1f} {:.1f}", command, frame.at_x(band.x[end]), frame.at_y(band.high[end]));
    }
    for (std::size_t i = end; i-- > first;) {
      path += fmt::format("L{:.1f} {:.1f}", frame.at_x(band.x[i]), frame.at_y(band.low[i]));
    }
    path += 'Z';
    first = end;
  }
  if (!path.empty()) page.add(R"(<path d="{}" fill="{}" fill-opacity="{}"/>)", path, band.colour, band.opacity);
}

void draw_line(Page& page, const PlotLine& line, const Frame& frame) {
  std::string path;
  bool broken = true;
  for (std::size_t i = 0; i < std::min(line.x.size(), line.y.size()); ++i) {
    if (!frame.shows(line.x[i], line.y[i])) {
      broken = true;
      continue;
    }
    path += fmt::format("{}{:.1f} {:.1f}", broken ? 'M' : 'L', frame.at_x(line.x[i]), frame.at_y(line.y[i]));
    broken = false;
  }
  if (path.empty()) return;
  page.add(R"(<path d="{}" fill="none" stroke="{}" stroke-width="{}" stroke-linejoin="round"{}/>)", path, line.colour,
           line.width, line.dashed ? R"( stroke-dasharray="4 3")" : "");
}

/// An occupied place: left and right end, and the baseline of a text there.
struct TakenPlace {
  double left, right, y;

  bool covers(const TakenPlace& other) const {
    constexpr double line_height = 10;
    return left < other.right && other.left < right && std::abs(y - other.y) < line_height;
  }
};

/// Draws a text next to its point, above or below it, right or left. Uses the first free place within the frame.
void draw_point_text(Page& page, const Frame& frame, double x, double y, const std::string& text,
                     const std::string& colour, std::vector<TakenPlace>& taken) {
  constexpr double size = 10;
  const bool to_the_left = x > frame.left + 0.7 * frame.width;
  const double width = text_width(text) * size / 11;  // text_width is for 11 pixels
  const auto beside = [&](bool left, double down) {
    return left ? TakenPlace{x - 6 - width, x - 6, y + down} : TakenPlace{x + 6, x + 6 + width, y + down};
  };
  constexpr double above = -4, below = 12;
  const std::array places = {beside(to_the_left, above), beside(to_the_left, below), beside(!to_the_left, above),
                             beside(!to_the_left, below)};
  const auto is_within = [&](const TakenPlace& place) {
    return place.left >= frame.left && place.right <= frame.left + frame.width;
  };
  const auto is_free = [&](const TakenPlace& place) {
    return is_within(place) && std::ranges::none_of(taken, [&](const TakenPlace& one) { return one.covers(place); });
  };
  auto found = std::ranges::find_if(places, is_free);
  if (found == places.end()) found = std::ranges::find_if(places, is_within);
  const TakenPlace& place = found != places.end() ? *found : places.front();
  const bool ends_here = place.right < x;  // aligned at the point, because widths are estimates
  page.text(ends_here ? place.right : place.left, place.y, ends_here ? "end" : "start", text, colour, size);
  taken.push_back(place);
}

void draw_points(Page& page, const PlotPoints& points, const Frame& frame, std::vector<TakenPlace>& taken) {
  for (std::size_t i = 0; i < std::min(points.x.size(), points.y.size()); ++i) {
    if (!frame.shows(points.x[i], points.y[i])) continue;
    const double x = frame.at_x(points.x[i]), y = frame.at_y(points.y[i]);
    page.add(R"(<circle cx="{:.1f}" cy="{:.1f}" r="3" fill="{}"/>)", x, y, points.colour);
    taken.push_back({x - 4, x + 4, y + 3});
  }
}

void draw_texts(Page& page, const PlotPoints& points, const Frame& frame, std::vector<TakenPlace>& taken) {
  for (std::size_t i = 0; i < std::min({points.x.size(), points.y.size(), points.text.size()}); ++i) {
    if (!frame.shows(points.x[i], points.y[i]) || points.text[i].empty()) continue;
    const double x = frame.at_x(points.x[i]), y = frame.at_y(points.y[i]);
    draw_point_text(page, frame, x, y, points.text[i], points.colour, taken);
  }
}

enum class Swatch { band, line, dashed, point };

struct LegendEntry {
  Swatch swatch;
  std::string_view label, colour;
  double opacity;
};

/// Adds the legend entries of a panel. A label is added once, with its highest opacity.
void add_legend(const PlotPanel& panel, std::vector<LegendEntry>& entries) {
  const auto add = [&](Swatch swatch, const std::string& label, const std::string& colour, double opacity) {
    if (label.empty()) return;
    const auto known = std::ranges::find(entries, label, &LegendEntry::label);
    if (known == entries.end()) {
      entries.push_back({swatch, label, colour, opacity});
    } else {
      known->opacity = std::max(known->opacity, opacity);
    }
  };
  for (const auto& line : panel.lines) add(line.dashed ? Swatch::dashed : Swatch::line, line.label, line.colour, 1);
  for (const auto& band : panel.bands) add(Swatch::band, band.label, band.colour, band.opacity);
  for (const auto& points : panel.points) add(Swatch::point, points.label, points.colour, 1);
}

double legend_width(const LegendEntry& entry) {
  return swatch_width + 19 + text_width(entry.label);
}

void draw_entry(Page& page, const LegendEntry& entry, double x, double y) {
  if (entry.swatch == Swatch::band) {
    page.add(R"(<rect x="{:.1f}" y="{:.1f}" width="{}" height="10" fill="{}" fill-opacity="{}"/>)", x, y - 5,
             swatch_width, entry.colour, entry.opacity);
  } else if (entry.swatch == Swatch::point) {
    page.add(R"(<circle cx="{:.1f}" cy="{:.1f}" r="3" fill="{}"/>)", x + swatch_width / 2, y, entry.colour);
  } else {
    page.add(R"(<path d="M{:.1f} {:.1f}h{}" stroke="{}" stroke-width="2"{}/>)", x, y, swatch_width, entry.colour,
             entry.swatch == Swatch::dashed ? R"( stroke-dasharray="4 3")" : "");
  }
  page.text(x + swatch_width + 5, y + 4, "start", entry.label);
}

/// Draws the legend on `page`, unless null. Returns its number of rows.
std::size_t draw_legend(Page* page, const std::vector<LegendEntry>& entries, double top, double width) {
  if (entries.empty()) return 0;
  std::size_t rows = 1;
  double x = margin;
  for (const auto& entry : entries) {
    if (x > margin && x + legend_width(entry) > width - margin) {
      ++rows;
      x = margin;
    }
    if (page != nullptr) draw_entry(*page, entry, x, top + legend_height * (static_cast<double>(rows) - 0.5));
    x += legend_width(entry);
  }
  return rows;
}

/// Draws a panel's own legend above it, aligned to the right.
void draw_own_legend(Page& page, const PlotPanel& panel, const Frame& frame) {
  std::vector<LegendEntry> entries;
  add_legend(panel, entries);
  double x = frame.left + frame.width + 14;
  for (const auto& entry : entries) x -= legend_width(entry);
  for (const auto& entry : entries) {
    draw_entry(page, entry, x, frame.top - 10);
    x += legend_width(entry);
  }
}

struct PanelRanges {
  Range x, y;
};

std::vector<PanelRanges> ranges_of(const PlotFigure& figure, std::size_t columns) {
  std::vector<PanelRanges> ranges(figure.panels.size());
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const PlotPanel& panel = figure.panels[i];
    ranges[i].x.logarithmic = panel.x.logarithmic;
    ranges[i].y.logarithmic = panel.y.logarithmic;
    include_x(panel, ranges[i].x);
    const std::size_t first = figure.shared_y ? i - i % columns : i;
    const std::size_t end = figure.shared_y ? std::min(first + columns, ranges.size()) : i + 1;
    for (std::size_t k = first; k < end; ++k) include_y(figure.panels[k], ranges[i].y);
    ranges[i].x = settled(ranges[i].x, panel.x, 0);
    ranges[i].y = settled(ranges[i].y, figure.panels[first].y, 0.05);
  }
  return ranges;
}

std::span<const PlotPanel> row_of(const PlotFigure& figure, std::size_t row, std::size_t columns) {
  const std::size_t first = row * columns;
  return std::span(figure.panels).subspan(first, std::min(columns, figure.panels.size() - first));
}

/// Returns the height above the panels of a row, 0 without titles and own legends.
double space_over(const PlotFigure& figure, std::size_t row, std::size_t columns) {
  const auto named = [](const PlotPanel& panel) { return !panel.title.empty() || panel.own_legend; };
  return std::ranges::any_of(row_of(figure, row, columns), named) ? panel_title_height : 0;
}

/// Returns the height of a row with titles, ticks, labels and the gap to the next.
double row_height(const PlotFigure& figure, std::size_t row, std::size_t columns) {
  const auto labelled = [](const PlotPanel& panel) { return !panel.x.label.empty(); };
  const bool label = std::ranges::any_of(row_of(figure, row, columns), labelled);
  return space_over(figure, row, columns) + figure.panel_height + tick_height + (label ? axis_label_height : 0) + 10;
}

}  // namespace

std::vector<double> plot_ticks(double low, double high, bool logarithmic, int count) {
  std::vector<double> ticks;
  if (!(std::isfinite(low) && std::isfinite(high) && low < high) || (logarithmic && low <= 0)) return ticks;
  if (logarithmic) {
    const bool dense = std::log10(high / low) < 3;
    for (double decade = std::floor(std::log10(low)); decade <= std::ceil(std::log10(high)); ++decade) {
      for (const double times : {1.0, 2.0, 5.0}) {
        const double tick = times * std::pow(10, decade);
        if (tick >= low * (1 - 1e-9) && tick <= high * (1 + 1e-9) && (dense || times == 1)) ticks.push_back(tick);
      }
    }
    return ticks;
  }
  const double rough = (high - low) / std::max(count, 1);
  const double decade = std::pow(10, std::floor(std::log10(rough)));
  double step = 10 * decade;
  for (const double times : {5.0, 2.0, 1.0}) {
    if (times * decade >= rough * 0.99) step = times * decade;
  }
  for (double i = std::ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) ticks.push_back(i * step);
  return ticks;
}

std::string svg(const PlotFigure& figure) {
  const std::size_t columns = std::max<std::size_t>(figure.columns, 1);
  const std::size_t rows = (figure.panels.size() + columns - 1) / columns;
  const double before_first = margin + y_label_width + y_tick_width;
  const double before_next = figure.shared_y ? gap : gap + y_label_width + y_tick_width;
  const double width = before_first + static_cast<double>(columns) * figure.panel_width +
                       static_cast<double>(columns - 1) * before_next + margin;
  std::vector<LegendEntry> legend;
  for (const auto& panel : figure.panels) {
    if (!panel.own_legend) add_legend(panel, legend);
  }
  const double legend_top = margin + (figure.title.empty() ? 0 : title_height);
  const double panels_top =
      legend_top + legend_height * static_cast<double>(draw_legend(nullptr, legend, 0, width)) + 4;
  std::vector<double> row_top(rows + 1, panels_top);
  for (std::size_t row = 0; row < rows; ++row) row_top[row + 1] = row_top[row] + row_height(figure, row, columns);
  const double height = row_top[rows] + (figure.footnote.empty() ? 0 : footnote_height) + margin / 2;

  Page page;
  page.add(
      R"(<svg xmlns="http://www.w3.org/2000/svg" width="{0:.0f}" height="{1:.0f}" viewBox="0 0 {0:.0f} {1:.0f}" font-family="Helvetica, Arial, sans-serif" font-size="11">)",
      width, height);
  page.add(R"(<rect width="100%" height="100%" fill="#fff"/>)");
  if (!figure.title.empty()) page.text(margin, margin + 14, "start", figure.title, "#111", 15, true);
  draw_legend(&page, legend, legend_top, width);

  const auto ranges = ranges_of(figure, columns);
  for (std::size_t i = 0; i < figure.panels.size(); ++i) {
    const PlotPanel& panel = figure.panels[i];
    const double left = before_first + static_cast<double>(i % columns) * (figure.panel_width + before_next);
    const double top = row_top[i / columns] + space_over(figure, i / columns, columns);
    const Frame frame{left, top, figure.panel_width, figure.panel_height, ranges[i].x, ranges[i].y};
    draw_axes(page, panel, frame, !figure.shared_y || i % columns == 0);
    if (panel.own_legend) draw_own_legend(page, panel, frame);
    page.add(R"(<clipPath id="p{}"><rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}"/></clipPath>)", i, left,
             top, frame.width, frame.height);
    page.add(R"svg(<g clip-path="url(#p{})">)svg", i);
    for (const auto& band : panel.bands) draw_band(page, band, frame);
    for (const auto& line : panel.lines) draw_line(page, line, frame);
    page.add("</g>");
    std::vector<TakenPlace> taken;
    for (const auto& points : panel.points) draw_points(page, points, frame, taken);
    for (const auto& points : panel.points) draw_texts(page, points, frame, taken);
    page.add(R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}" fill="none" stroke="#bbb"/>)", left, top,
             frame.width, frame.height);
  }
  if (!figure.footnote.empty()) page.text(margin, height - margin, "start", figure.footnote, faint, 10);
  page.add("</svg>");
  return page.body;
}

}  // namespace mobil
