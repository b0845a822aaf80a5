#pragma once
// One scene graph in two notations: VRML97, where nodes are fields of nodes, and X3D, which is XML.

#include <string>
#include <string_view>
#include <vector>

namespace mobil::inline v0_3 {

/// The two notations: VRML97 (ISO/IEC 14772-1) and X3D as XML (ISO/IEC 19776-1).
enum class SceneNotation { vrml, x3d };

/// A scene under way. Nodes are opened and closed in turn; a node's fields are given before what is inside it.
class SceneText {
 public:
  SceneText(SceneNotation notation, const std::string& title);

  /// A node of that type inside the one that is open: in VRML as its field `in` ("geometry"), or where that is empty as
  /// one of its children. `name`: what ROUTEs call it; an identifier, or none.
  void open(std::string_view type, std::string_view name = {}, std::string_view in = {});
  /// One value, or many in VRML's brackets.
  void field(std::string_view name, std::string_view value);
  void fields(std::string_view name, std::string_view values);
  void close();
  void route(std::string_view from, std::string_view out, std::string_view to, std::string_view in);

  /// The whole file; everything must be closed.
  std::string text() &&;

 private:
  struct Open {
    std::string type;
    bool list = false, inside = false;  // VRML: children's bracket is open; X3D: the tag is closed
  };
  void indent();

  SceneNotation notation_;
  std::string text_;
  std::vector<Open> open_;
};

}  // namespace mobil::inline v0_3
