#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace aftershade::io {

/// A value inside a JSON file that knows where it is, so that every complaint names file and key. All members throw
/// Error(config) when the value is of another kind.
class JsonReader {
 public:
  JsonReader(const nlohmann::ordered_json& value, std::string where) : value_(&value), where_(std::move(where)) {}

  bool is_text() const { return value_->is_string(); }
  std::string text() const;
  double number() const;  ///< finite
  bool boolean() const;
  int choice(const std::vector<std::string>& names) const;  ///< index into `names`
  std::vector<JsonReader> elements() const;
  std::vector<std::pair<std::string, JsonReader>> members() const;
  bool has(const std::string& key) const;
  JsonReader required(const std::string& key) const;
  void optional(const std::string& key, const std::function<void(const JsonReader&)>& use) const;
  /// Refuses every key that is not in `keys`, with "did you mean".
  void allow(const std::vector<std::string>& keys) const;
  [[noreturn]] void fail(std::string_view what, std::string hint = {}) const;

 private:
  void need_object() const;
  std::string member(const std::string& key) const;
  const nlohmann::ordered_json* value_;
  std::string where_;  ///< "blender.json: depth[0].kind"
};

/// A JSON text, parsed. Comments are allowed, a key given twice is refused.
class JsonDocument {
 public:
  JsonDocument(std::string_view text, std::string_view file_name);
  JsonReader root() const { return {value_, file_name_}; }

 private:
  nlohmann::ordered_json value_;
  std::string file_name_;
};

/// A unit of length as metres_per_unit() takes it: a name, or metres as a number.
std::string read_unit(const JsonReader& value);

/// The whole file; Error(config) with the reason.
std::string read_text_file(const std::string& path);

}  // namespace aftershade::io
