#pragma once
// One scene graph in two notations: VRML97, in which nodes are fields of nodes, and X3D, which is XML.

#include <string>
#include <string_view>
#include <vector>

namespace mobil::inline v0_3 {

/// The two notations: VRML97 (ISO/IEC 14772-1) and X3D as XML (ISO/IEC 19776-1).
enum class SceneNotation { vrml, x3d };

/// A scene being written. Nodes are opened and closed in turn; a node's fields precede its children.
class SceneText {
 public:
  SceneText(SceneNotation notation, const std::string& title);

  /// Opens a node of that type inside the open one: in VRML as its field `in` ("geometry"), or as one of its children
  /// if that is empty. `name` is an identifier for ROUTEs, or empty.
  void open(std::string_view type, std::string_view name = {}, std::string_view in = {});
  /// Write one value, or many in VRML's brackets.
  void field(std::string_view name, std::string_view value);
  void fields(std::string_view name, std::string_view values);
  void close();
  void route(std::string_view from, std::string_view out, std::string_view to, std::string_view in);

  /// Returns the complete file. All nodes must be closed.
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
