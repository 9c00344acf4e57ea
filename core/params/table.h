#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// One record per parameter (DESIGN 3): reading and writing JSON, --set, --help, the manual page, the JSON Schema,
/// range errors and the tests of the tables are loops over these records.
namespace aftershade::params {

using Json = nlohmann::ordered_json;

/// Inclusive bounds of a number; both ends are part of the message when a value lies outside.
struct Range {
  double min, max;
};

enum class Kind { number, integer, boolean, choice, text };

/// A parameter: its key carries its unit as a suffix ("radius_m", "max_radius_px", "bias_deg").
struct Record {
  std::string key;
  Kind kind;
  Range range{0, 0};                 ///< number and integer
  std::vector<std::string> choices;  ///< choice
  std::string doc;                   ///< one sentence for the reader of --help and of the manual
  Json default_value;
  std::function<Json(const void*)> get;
  std::function<void(void*, const Json&)> put;  ///< the value has passed check()
};
using Table = std::vector<Record>;

/// A float as the decimal that a person would write: 0.05f gives 0.05, not 0.0500000007.
Json json_of(float value);

/// Builds the table of struct S; defaults are the member initialisers of S.
template <class S>
class TableBuilder {
 public:
  TableBuilder& add(std::string_view key, float S::*member, Range range, std::string_view doc) {
    return add(
        key, Kind::number, range, {}, doc,
        [member](const void* s) { return json_of(static_cast<const S*>(s)->*member); },
        [member](void* s, const Json& v) { static_cast<S*>(s)->*member = v.get<float>(); });
  }
  TableBuilder& add(std::string_view key, int S::*member, Range range, std::string_view doc) {
    return add(
        key, Kind::integer, range, {}, doc, [member](const void* s) { return Json(static_cast<const S*>(s)->*member); },
        [member](void* s, const Json& v) { static_cast<S*>(s)->*member = v.get<int>(); });
  }
  TableBuilder& add(std::string_view key, bool S::*member, std::string_view doc) {
    return add(
        key, Kind::boolean, {}, {}, doc, [member](const void* s) { return Json(static_cast<const S*>(s)->*member); },
        [member](void* s, const Json& v) { static_cast<S*>(s)->*member = v.get<bool>(); });
  }
  TableBuilder& add(std::string_view key, std::string S::*member, std::string_view doc) {
    return add(
        key, Kind::text, {}, {}, doc, [member](const void* s) { return Json(static_cast<const S*>(s)->*member); },
        [member](void* s, const Json& v) { static_cast<S*>(s)->*member = v.get<std::string>(); });
  }
  /// An enum; `names[i]` is the JSON spelling of static_cast<E>(i).
  template <class E, class Base>
  requires std::is_enum_v<E> && std::is_base_of_v<Base, S> TableBuilder& add(std::string_view key, E Base::*member,
                                                                             std::vector<std::string> names,
                                                                             std::string_view doc) {
    return add(
        key, Kind::choice, {}, names, doc,
        [member, names](const void* s) {
          return Json(names.at(static_cast<size_t>(static_cast<const S*>(s)->*member)));
        },
        [member, names](void* s, const Json& v) {
          for (size_t i = 0; i < names.size(); ++i)
            if (v == names[i]) static_cast<S*>(s)->*member = static_cast<E>(i);
        });
  }
  Table build() { return std::move(table_); }

 private:
  TableBuilder& add(std::string_view key, Kind kind, Range range, std::vector<std::string> choices,
                    std::string_view doc, std::function<Json(const void*)> get,
                    std::function<void(void*, const Json&)> put) {
    const S defaults{};
    table_.push_back(
        {std::string(key), kind, range, std::move(choices), std::string(doc), get(&defaults), get, std::move(put)});
    return *this;
  }
  Table table_;
};

/// Throws Error(config) unless `value` has the record's type and lies in its range; `where` ("high.json: stage ao")
/// leads the message: "high.json: stage ao: radius_m: -1 is out of range 0.001 to 1000 m".
void check(const Record& record, const Json& value, std::string_view where);

/// Throws Error(config): `unknown key "radus_m"`, with "did you mean" or else all that are known.
[[noreturn]] void unknown_key(std::string_view key, std::span<const std::string> known, std::string_view where);

/// The record with this key, or Error(config) with "did you mean".
const Record& find(const Table& table, std::string_view key, std::string_view where);

/// Sets the members that `object` (a JSON object) names; checks keys, types and ranges.
void read(const Table& table, void* target, const Json& object, std::string_view where);

/// All parameters of `source`, in the table's order.
Json write(const Table& table, const void* source);

/// The text that --set gives, as JSON of the record's kind ("1.5", "true", "planar"); throws Error(config).
Json parse_value(const Record& record, std::string_view text, std::string_view where);

/// JSON Schema (draft 7) of the table: an object {"key": {"type", "minimum", "maximum", "default", "description"}}.
Json schema_properties(const Table& table);

/// The unit of a number, from its key's suffix: "m" of "radius_m", "px", "deg", "texels", "footprints", "frames"; else
/// "".
std::string_view unit(const Record& record);

/// "0.001 to 1000 m", "one of planar, ray", "true or false", "any text": for help and manual.
std::string domain_text(const Record& record);

}  // namespace aftershade::params
