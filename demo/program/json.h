#pragma once
// JSON for writing, with members in the order in which they were set. Only json.cpp includes the JSON library, because
// its header takes four seconds to compile.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace mobil {

class Json {
 public:
  Json() = default;  // null
  Json(std::nullptr_t) {}
  Json(bool value) : kind_(Kind::boolean), integer_(value ? 1 : 0) {}
  Json(double value) : kind_(Kind::number), number_(value) {}
  Json(float value) : Json(static_cast<double>(value)) {}
  template <std::signed_integral T>
  Json(T value) : kind_(Kind::integer), integer_(value) {}
  template <std::unsigned_integral T>
  Json(T value) : kind_(Kind::count), count_(value) {}
  Json(std::string_view text);
  Json(const char* text) : Json(std::string_view(text)) {}
  Json(const std::string& text) : Json(std::string_view(text)) {}
  template <class Values>
  requires(requires(const Values& v) { v.begin(); } && !std::convertible_to<Values, std::string_view>)
      Json(const Values& values)
      : Json(array()) {
    for (const auto& value : values) push_back(value);
  }
  /// {{"name", value}, …} is an object, any other list an array.
  Json(std::initializer_list<Json> list);

  Json(const Json&);
  Json(Json&&) noexcept;
  Json& operator=(Json) noexcept;
  ~Json();

  static Json array();
  static Json object();

  /// Returns the member of that name, and adds it if missing. Null becomes an object.
  Json& operator[](std::string_view name);
  /// Appends to an array; null becomes an array. The returned reference is valid until the next item is added.
  Json& push_back(Json item);
  /// Sets every member of `object`.
  void update(const Json& object);

  /// Returns UTF-8, `indent` spaces per level. Numbers have about the shortest form that reads the same; NaN is null.
  std::string dump(int indent) const;

 private:
  friend struct JsonWriter;
  enum class Kind : std::uint8_t { null, boolean, integer, count, number, text, array, object };
  Kind kind_ = Kind::null;
  union {
    std::int64_t integer_ = 0;
    std::uint64_t count_;
    double number_;
  };
  std::string text_;
  std::vector<std::string> names_;  // of an object's items
  std::vector<Json> items_;
};

}  // namespace mobil
