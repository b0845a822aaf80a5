#pragma once
// Small tables of numbers with units, for people and as CSV.

#include <string>
#include <vector>

namespace mobil {

/// A row has a number for each column; one that is not finite is left empty.
struct PaperTable {
  struct Column {
    std::string name, head;  // in the CSV, with its unit; for people
    int decimals = 1;        // for people
  };
  struct Row {
    std::string label;
    std::vector<double> value;
  };
  std::string label_name;  // of the first column, which has the rows' labels
  std::vector<Column> column;
  std::vector<Row> row;
};

/// Returns the table aligned for a terminal. Heads can have several lines, and so can labels that become heads.
std::string table_text(const PaperTable& table);

/// Returns the table with a line for each column, for tables of few rows.
std::string turned_table_text(const PaperTable& table);

std::string table_csv(const PaperTable& table);

}  // namespace mobil
