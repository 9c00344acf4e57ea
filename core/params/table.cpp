#include "core/params/table.h"

#include <array>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"

namespace aftershade::params {

Json json_of(float value) {
  if (!std::isfinite(value)) return value;
  return *parse_number(cat(value));
}

namespace {

/// 5.0 is whole, as JSON Schema says.
bool is_whole(const Json& value) {
  if (value.is_number_float()) return std::trunc(value.get<double>()) == value.get<double>();
  return value.is_number_integer();
}

bool has_kind(const Record& record, const Json& value) {
  switch (record.kind) {
    case Kind::number:
      return value.is_number();
    case Kind::integer:
      return is_whole(value);
    case Kind::boolean:
      return value.is_boolean();
    case Kind::choice:
    case Kind::text:
      return value.is_string();
  }
  return false;
}

const char* kind_text(Kind kind) {
  switch (kind) {
    case Kind::number:
      return "a number";
    case Kind::integer:
      return "a whole number";
    case Kind::boolean:
      return "true or false";
    case Kind::choice:
    case Kind::text:
      return "a text in quotes";
  }
  return "";
}

[[noreturn]] void fail(const Record& record, std::string_view where, const std::string& what, const std::string& hint) {
  throw Error(ErrorCode::config, cat(where, ": ", record.key, ": ", what), hint);
}

}  // namespace

void check(const Record& record, const Json& value, std::string_view where) {
  if (!has_kind(record, value)) fail(record, where, value.dump() + " is not " + kind_text(record.kind), record.doc);
  if (record.kind == Kind::choice) {
    const std::string name = value.get<std::string>();
    for (const std::string& choice : record.choices)
      if (choice == name) return;
    fail(record, where, "\"" + name + "\" is not " + domain_text(record), did_you_mean(name, record.choices));
  }
  if (record.kind != Kind::number && record.kind != Kind::integer) return;
  const double number = value.get<double>();
  if (!(number >= record.range.min && number <= record.range.max))
    fail(record, where, value.dump() + " is out of range " + domain_text(record), record.doc);
}

void unknown_key(std::string_view key, std::span<const std::string> known, std::string_view where) {
  const std::string guess = did_you_mean(key, known);
  throw Error(ErrorCode::config, cat(where, ": unknown key \"", key, "\""),
              guess.empty() ? "known keys: " + join(known, ", ") : guess);
}

const Record& find(const Table& table, std::string_view key, std::string_view where) {
  std::vector<std::string> keys;
  for (const Record& record : table) {
    if (record.key == key) return record;
    keys.push_back(record.key);
  }
  unknown_key(key, keys, where);
}

void read(const Table& table, void* target, const Json& object, std::string_view where) {
  for (const auto& [key, value] : object.items()) {
    const Record& record = find(table, key, where);
    check(record, value, where);
    record.put(target, value);
  }
}

Json write(const Table& table, const void* source) {
  Json object = Json::object();
  for (const Record& record : table) object[record.key] = record.get(source);
  return object;
}

Json parse_value(const Record& record, std::string_view text, std::string_view where) {
  Json value;
  if (record.kind == Kind::text || record.kind == Kind::choice) {
    value = std::string(text);
  } else if (record.kind == Kind::boolean && (text == "true" || text == "false")) {
    value = text == "true";
  } else if (const auto integer = parse_integer(text)) {
    value = *integer;
  } else if (const auto number = parse_number(text); number && std::isfinite(*number)) {
    value = *number;
  } else {
    value = std::string(text);
  }
  check(record, value, where);
  return value;
}

namespace {
Json bound(const Record& record, double value) {
  return record.kind == Kind::integer ? Json(static_cast<long>(value)) : Json(value);
}
}  // namespace

Json schema_properties(const Table& table) {
  Json properties = Json::object();
  for (const Record& record : table) {
    Json& entry = properties[record.key] = Json::object();
    switch (record.kind) {
      case Kind::number:
      case Kind::integer:
        entry["type"] = record.kind == Kind::number ? "number" : "integer";
        entry["minimum"] = bound(record, record.range.min);
        entry["maximum"] = bound(record, record.range.max);
        break;
      case Kind::boolean:
        entry["type"] = "boolean";
        break;
      case Kind::choice:
        entry["enum"] = record.choices;
        break;
      case Kind::text:
        entry["type"] = "string";
        break;
    }
    entry["default"] = record.default_value;
    entry["description"] = record.doc;
  }
  return properties;
}

std::string_view unit(const Record& record) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kSuffixes{{{"_m", "m"},
                                                                                    {"_px", "px"},
                                                                                    {"_deg", "deg"},
                                                                                    {"_texels", "texels"},
                                                                                    {"_footprints", "footprints"},
                                                                                    {"_frames", "frames"}}};
  if (record.kind != Kind::number && record.kind != Kind::integer) return "";
  for (const auto& [suffix, name] : kSuffixes)
    if (record.key.ends_with(suffix)) return name;
  return "";
}

std::string domain_text(const Record& record) {
  switch (record.kind) {
    case Kind::number:
    case Kind::integer:
      return cat(record.range.min, " to ", record.range.max, unit(record).empty() ? "" : " ", unit(record));
    case Kind::boolean:
      return "true or false";
    case Kind::choice:
      return "one of " + join(record.choices, ", ");
    case Kind::text:
      return "any text";
  }
  return "";
}

}  // namespace aftershade::params
