#include "core/io/json.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <set>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"

namespace aftershade::io {

void JsonReader::fail(std::string_view what, std::string hint) const {
  throw Error(ErrorCode::config, cat(where_, ": ", what), std::move(hint));
}

std::string JsonReader::text() const {
  if (!value_->is_string()) fail("must be a text");
  return value_->get<std::string>();
}

double JsonReader::number() const {
  if (!value_->is_number()) fail("must be a number");
  const double value = value_->get<double>();
  if (!std::isfinite(value)) fail("must be a finite number");
  return value;
}

bool JsonReader::boolean() const {
  if (!value_->is_boolean()) fail("must be true or false");
  return value_->get<bool>();
}

int JsonReader::choice(const std::vector<std::string>& names) const {
  const std::string word = text();
  for (size_t i = 0; i < names.size(); ++i)
    if (names[i] == word) return static_cast<int>(i);
  fail(cat("\"", word, "\" is not one of ", join(names, ", ")), did_you_mean(word, names));
}

std::vector<JsonReader> JsonReader::elements() const {
  if (!value_->is_array()) fail("must be a list");
  std::vector<JsonReader> out;
  for (size_t i = 0; i < value_->size(); ++i) out.emplace_back((*value_)[i], cat(where_, "[", i, "]"));
  return out;
}

std::string JsonReader::member(const std::string& key) const {
  return cat(where_, where_.find(": ") == std::string::npos ? ": " : ".", key);
}

void JsonReader::need_object() const {
  if (!value_->is_object()) fail("must be an object {...}");
}

std::vector<std::pair<std::string, JsonReader>> JsonReader::members() const {
  need_object();
  std::vector<std::pair<std::string, JsonReader>> out;
  for (const auto& [key, value] : value_->items()) out.emplace_back(key, JsonReader(value, member(key)));
  return out;
}

bool JsonReader::has(const std::string& key) const {
  need_object();
  return value_->contains(key);
}

JsonReader JsonReader::required(const std::string& key) const {
  if (!has(key)) fail(cat("\"", key, "\" is missing"));
  return {value_->at(key), member(key)};
}

void JsonReader::optional(const std::string& key, const std::function<void(const JsonReader&)>& use) const {
  if (has(key)) use(required(key));
}

void JsonReader::allow(const std::vector<std::string>& keys) const {
  for (const auto& [key, value] : members())
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
      const std::string guess = did_you_mean(key, keys);
      fail(cat("unknown key \"", key, "\""), guess.empty() ? "known are " + join(keys, ", ") : guess);
    }
}

JsonDocument::JsonDocument(std::string_view text, std::string_view file_name) : file_name_(file_name) {
  std::vector<std::set<std::string>> open;  // keys seen so far of the objects that are being read
  std::string twice;
  const auto watch = [&](int, nlohmann::ordered_json::parse_event_t event, nlohmann::ordered_json& value) {
    using Event = nlohmann::ordered_json::parse_event_t;
    if (event == Event::object_start) open.emplace_back();
    if (event == Event::object_end) open.pop_back();
    if (event == Event::key && !open.back().insert(value.get<std::string>()).second) twice = value.get<std::string>();
    return true;
  };
  try {
    value_ = nlohmann::ordered_json::parse(text, watch, true, true);
  } catch (const nlohmann::json::exception& error) {
    throw Error(ErrorCode::config, cat(file_name, ": not valid JSON: ", error.what()));
  }
  if (!twice.empty())
    throw Error(ErrorCode::config, cat(file_name, ": key \"", twice, "\" is given twice in one object"));
}

std::string read_text_file(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (!stream) throw Error(ErrorCode::no_input, cat("cannot read \"", path, "\": ", std::strerror(errno)));
  return text;
}

std::string read_unit(const JsonReader& value) {
  const std::string unit = value.is_text() ? value.text() : cat(value.number());
  try {
    metres_per_unit(unit);
  } catch (const Error& error) {
    value.fail(error.message(), error.hint());
  }
  return unit;
}

}  // namespace aftershade::io
