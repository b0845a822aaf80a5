#pragma once
// Reads the elements of an XML file.

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "engine/eigen.h"
#include "tests/files/temporary_folder.h"

namespace mobil::xml {

struct XmlElement {
  std::string tag;
  std::map<std::string, std::string> attribute;
  std::size_t parent;  // number in the list
  std::string text;    // before its first child
};

/// Reads elements in the order of the file. The first one is the document.
inline std::vector<XmlElement> elements_of(const std::filesystem::path& file) {
  const std::string text = read_bytes(file);
  const std::regex tag("<(/?)(\\w+)([^<>]*?)(/?)>([^<]*)"), pair("(\\w+)=\"([^\"]*)\"");
  std::vector<XmlElement> all{{"", {}, 0, ""}};
  std::size_t open = 0;
  for (std::sregex_iterator it(text.begin(), text.end(), tag), end; it != end; ++it) {
    const std::smatch& m = *it;
    if (m[1].length() > 0) {
      EXPECT_EQ(all[open].tag, m[2]);
      open = all[open].parent;
      continue;
    }
    XmlElement element{m[2], {}, open, m[5]};
    const std::string attributes = m[3];
    for (std::sregex_iterator a(attributes.begin(), attributes.end(), pair); a != end; ++a)
      element.attribute[(*a)[1]] = (*a)[2];
    all.push_back(element);
    if (m[4].length() == 0) open = all.size() - 1;
  }
  EXPECT_EQ(open, 0U);
  return all;
}

inline std::vector<double> numbers(const std::string& text) {
  std::vector<double> values;
  std::istringstream in(text);
  for (double value = 0; in >> value;) values.push_back(value);
  return values;
}
inline Eigen::Vector3d vector3(const std::string& text) {
  const auto v = numbers(text);
  return {v.at(0), v.at(1), v.at(2)};
}

}  // namespace mobil::xml
