#include "demo/program/json.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

namespace mobil {

struct JsonWriter {
  using Kind = Json::Kind;

  /// {"name", value}
  static bool names_value(const Json& pair) {
    return pair.kind_ == Kind::array && pair.items_.size() == 2 && pair.items_[0].kind_ == Kind::text;
  }

  static nlohmann::ordered_json tree(const Json& json) {
    switch (json.kind_) {
      case Kind::null:
        return nullptr;
      case Kind::boolean:
        return json.integer_ != 0;
      case Kind::integer:
        return json.integer_;
      case Kind::count:
        return json.count_;
      case Kind::number:
        return json.number_;
      case Kind::text:
        return json.text_;
      case Kind::array:
      case Kind::object:
        break;
    }
    const bool named = json.kind_ == Kind::object;
    auto made = named ? nlohmann::ordered_json::object() : nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < json.items_.size(); ++i) {
      if (named) {
        made[json.names_[i]] = tree(json.items_[i]);
      } else {
        made.push_back(tree(json.items_[i]));
      }
    }
    return made;
  }
};

Json::Json(std::string_view text) : kind_(Kind::text), text_(text) {}

Json::Json(std::initializer_list<Json> list) : kind_(Kind::array) {
  if (std::ranges::all_of(list, &JsonWriter::names_value)) {
    kind_ = Kind::object;
    for (const Json& pair : list) (*this)[pair.items_[0].text_] = pair.items_[1];
  } else {
    items_ = list;
  }
}

Json::Json(const Json&) = default;
Json::Json(Json&&) noexcept = default;
Json::~Json() = default;

Json& Json::operator=(Json other) noexcept {
  kind_ = other.kind_;
  integer_ = other.integer_;
  text_.swap(other.text_);
  names_.swap(other.names_);
  items_.swap(other.items_);
  return *this;
}

Json Json::array() {
  Json made;
  made.kind_ = Kind::array;
  return made;
}

Json Json::object() {
  Json made;
  made.kind_ = Kind::object;
  return made;
}

Json& Json::operator[](std::string_view name) {
  if (kind_ == Kind::null) kind_ = Kind::object;
  const auto at = std::ranges::find(names_, name);
  if (at != names_.end()) return items_[static_cast<std::size_t>(at - names_.begin())];
  names_.emplace_back(name);
  return items_.emplace_back();
}

Json& Json::push_back(Json item) {
  if (kind_ == Kind::null) kind_ = Kind::array;
  return items_.emplace_back(std::move(item));
}

void Json::update(const Json& object) {
  for (std::size_t i = 0; i < object.items_.size(); ++i) (*this)[object.names_[i]] = object.items_[i];
}

std::string Json::dump(int indent) const {
  return JsonWriter::tree(*this).dump(indent, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace mobil
