#include <mobil/assets/export/scene_text.h>

#include <fmt/format.h>

#include <utility>

namespace mobil::inline v0_3 {

SceneText::SceneText(SceneNotation notation, const std::string& title) : notation_(notation) {
  if (notation == SceneNotation::vrml) {
    text_ = fmt::format("#VRML V2.0 utf8\nWorldInfo {{ title \"{}\" }}\n", title);
    return;
  }
  text_ = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<!DOCTYPE X3D PUBLIC \"ISO//Web3D//DTD X3D 3.3//EN\" \"http://www.web3d.org/specifications/x3d-3.3.dtd\">\n"
      "<X3D profile='Immersive' version='3.3'>\n<head><meta name='title' content='{}'/></head>\n<Scene>\n",
      title);
}

void SceneText::indent() {
  text_.append(2 * open_.size(), ' ');
}

void SceneText::open(std::string_view type, std::string_view name, std::string_view in) {
  if (notation_ == SceneNotation::x3d) {
    if (!open_.empty() && !std::exchange(open_.back().inside, true)) text_ += ">\n";
    indent();
    text_ += fmt::format("<{}", type);
    if (!name.empty()) text_ += fmt::format(" DEF='{}'", name);
  } else {
    const bool child = in.empty() && !open_.empty();
    if (child && !std::exchange(open_.back().list, true)) {
      indent();
      text_ += "children [\n";
    }
    indent();
    if (!in.empty()) text_ += fmt::format("{} ", in);
    if (!name.empty()) text_ += fmt::format("DEF {} ", name);
    text_ += fmt::format("{} {{\n", type);
  }
  open_.push_back({std::string(type)});
}

void SceneText::field(std::string_view name, std::string_view value) {
  if (notation_ == SceneNotation::x3d) {
    const bool truth = value == "TRUE" || value == "FALSE";
    text_ += fmt::format(" {}='{}'", name, truth ? (value == "TRUE" ? "true" : "false") : value);
    return;
  }
  indent();
  text_ += fmt::format("{} {}\n", name, value);
}

void SceneText::fields(std::string_view name, std::string_view values) {
  if (notation_ == SceneNotation::x3d) return field(name, values);
  indent();
  text_ += fmt::format("{} [ {} ]\n", name, values);
}

void SceneText::close() {
  const Open closed = open_.back();
  if (notation_ == SceneNotation::vrml && closed.list) {
    indent();
    text_ += "]\n";
  }
  open_.pop_back();
  if (notation_ == SceneNotation::x3d && !closed.inside) {
    text_ += "/>\n";
    return;
  }
  indent();
  text_ += notation_ == SceneNotation::x3d ? fmt::format("</{}>\n", closed.type) : "}\n";
}

void SceneText::route(std::string_view from, std::string_view out, std::string_view to, std::string_view in) {
  if (notation_ == SceneNotation::x3d) {
    text_ += fmt::format("<ROUTE fromNode='{}' fromField='{}' toNode='{}' toField='{}'/>\n", from, out, to, in);
  } else {
    text_ += fmt::format("ROUTE {}.{} TO {}.{}\n", from, out, to, in);
  }
}

std::string SceneText::text() && {
  if (notation_ == SceneNotation::x3d) text_ += "</Scene>\n</X3D>\n";
  return std::move(text_);
}

}  // namespace mobil::inline v0_3
