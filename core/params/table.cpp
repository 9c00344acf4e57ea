#include "core/params/table.h"

#include <charconv>
#include <cmath>

#include "core/base/error.h"
#include "core/base/text.h"

namespace aftershade::params {

Json json_of(float value) {
  if (!std::isfinite(value)) return value;
  return *parse_number(cat(value));
}

namespace {

bool has_kind(const Record& record, const Json& value) {
  switch (record.kind) {
    case Kind::number: return value.is_number();
    case Kind::integer: return value.is_number_integer();
    case Kind::boolean: return value.is_boolean();
    case Kind::choice:
    case Kind::text: return value.is_string();
  }
  return false;
}

const char* kind_text(Kind kind) {
  switch (kind) {
    case Kind::number: return "a number";
    case Kind::integer: return "a whole number";
    case Kind::boolean: return "true or false";
    case Kind::choice:
    case Kind::text: return "a text in quotes";
  }
  return "";
}

[[noreturn]] void fail(const Record& record, std::string_view where, const std::string& what, const std::string& hint) {
  throw Error(ErrorCode::config, cat(where, ".", record.key, ": ", what), hint);
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

const Record& find(const Table& table, std::string_view key, std::string_view where) {
  std::vector<std::string> keys;
  for (const Record& record : table) {
    if (record.key == key) return record;
    keys.push_back(record.key);
  }
  std::string hint = did_you_mean(key, keys);
  if (hint.empty()) hint = "known keys: " + join(keys, ", ");
  throw Error(ErrorCode::config, cat(where, ": unknown key \"", key, "\""), hint);
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
  } else if (const auto number = parse_number(text)) {
    value = *number;
  } else {
    value = std::string(text);
  }
  check(record, value, where);
  return value;
}

Json schema_properties(const Table& table) {
  Json properties = Json::object();
  for (const Record& record : table) {
    Json& entry = properties[record.key] = Json::object();
    switch (record.kind) {
      case Kind::number:
      case Kind::integer:
        entry["type"] = record.kind == Kind::number ? "number" : "integer";
        entry["minimum"] = record.range.min;
        entry["maximum"] = record.range.max;
        break;
      case Kind::boolean: entry["type"] = "boolean"; break;
      case Kind::choice: entry["enum"] = record.choices; break;
      case Kind::text: entry["type"] = "string"; break;
    }
    entry["default"] = record.default_value;
    entry["description"] = record.doc;
  }
  return properties;
}

std::string domain_text(const Record& record) {
  switch (record.kind) {
    case Kind::number:
    case Kind::integer: return cat(record.range.min, " to ", record.range.max);
    case Kind::boolean: return "true or false";
    case Kind::choice: return "one of " + join(record.choices, ", ");
    case Kind::text: return "any text";
  }
  return "";
}

}  // namespace aftershade::params
