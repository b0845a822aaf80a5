#pragma once
// Published muscle lengths as tables, and the quality of a fit to them.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace mobil::test {

/// Names of the library's muscles in the published model.
inline const std::map<std::string_view, std::string> published_name = {{"semimembranosus", "semimem"},
                                                                       {"semitendinosus", "semiten"},
                                                                       {"biceps_femoris_long_head", "bifemlh"},
                                                                       {"biceps_femoris_short_head", "bifemsh"},
                                                                       {"rectus_femoris", "rect_fem"},
                                                                       {"vastus_medialis", "vas_med"},
                                                                       {"vastus_intermedius", "vas_int"},
                                                                       {"vastus_lateralis", "vas_lat"},
                                                                       {"gastrocnemius_medial", "med_gas"},
                                                                       {"gastrocnemius_lateral", "lat_gas"},
                                                                       {"soleus", "soleus"},
                                                                       {"tibialis_anterior", "tib_ant"}};

/// A row of a CSV file, by the names of its header.
struct TableRow {
  std::map<std::string, std::string, std::less<>> cell;

  bool has(std::string_view name) const {
    const auto found = cell.find(name);
    return found != cell.end() && !found->second.empty();
  }
  /// Returns a cell's number, or 0 if the table has no such column.
  double operator()(std::string_view name) const { return has(name) ? std::stod(cell.find(name)->second) : 0; }
};

inline std::vector<TableRow> read_table(const std::filesystem::path& file) {
  std::ifstream in(file);
  const auto cells = [](const std::string& line) {
    std::vector<std::string> found;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) found.push_back(cell);
    return found;
  };
  std::string line;
  std::getline(in, line);
  const auto names = cells(line);
  std::vector<TableRow> rows;
  while (std::getline(in, line)) {
    const auto values = cells(line);
    TableRow& row = rows.emplace_back();
    for (std::size_t i = 0; i < std::min(names.size(), values.size()); ++i) row.cell[names[i]] = values[i];
  }
  return rows;
}

struct Fit {
  std::vector<double> ours, published;

  void add(double our, double theirs) {
    ours.push_back(our);
    published.push_back(theirs);
  }
  double rms() const {
    double sum = 0;
    for (std::size_t i = 0; i < ours.size(); ++i) sum += (ours[i] - published[i]) * (ours[i] - published[i]);
    return std::sqrt(sum / static_cast<double>(ours.size()));
  }
  double correlation() const {
    const auto n = static_cast<double>(ours.size());
    double x = 0, y = 0, xx = 0, yy = 0, xy = 0;
    for (std::size_t i = 0; i < ours.size(); ++i) x += ours[i] / n, y += published[i] / n;
    for (std::size_t i = 0; i < ours.size(); ++i) {
      const double a = ours[i] - x, b = published[i] - y;
      xx += a * a, yy += b * b, xy += a * b;
    }
    return xy / std::sqrt(xx * yy);
  }
};

}  // namespace mobil::test
