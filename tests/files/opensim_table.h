#pragma once
// Reads a table of OpenSim.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace mobil {

/// A table of OpenSim, by column.
struct OpensimTable {
  std::map<std::string, std::string> header;
  std::map<std::string, std::vector<double>> column;
  std::vector<std::string> names;

  explicit OpensimTable(const std::filesystem::path& file) {
    std::ifstream in(file);
    std::string line;
    std::getline(in, line);
    while (std::getline(in, line) && line != "endheader")
      header[line.substr(0, line.find('='))] = line.substr(line.find('=') + 1);
    std::getline(in, line);
    std::istringstream titles(line);
    for (std::string name; std::getline(titles, name, '\t');) names.push_back(name);
    std::size_t rows = 0;
    for (; std::getline(in, line); ++rows) {
      std::istringstream cells(line);
      for (const auto& name : names) cells >> column[name].emplace_back();
      EXPECT_TRUE(cells) << line;
    }
    EXPECT_EQ(std::to_string(rows), header["nRows"]);
    EXPECT_EQ(std::to_string(names.size()), header["nColumns"]);
  }
  double at(const std::string& name, std::size_t row) const { return column.at(name).at(row); }
};

}  // namespace mobil
