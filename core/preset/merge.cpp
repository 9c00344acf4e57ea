#include "core/preset/merge.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <set>

#include "core/base/error.h"
#include "core/base/text.h"

namespace aftershade::preset {

using params::Json;

namespace {

/// One element of "stages" as written, sorted by what each key is for.
struct Entry {
  std::string id, where;  ///< where: "my.json: stage ao", in front of every message
  std::optional<std::string> method, before, after;
  bool remove = false;
  Json values = Json::object();  ///< parameters of the method, unchecked
};

std::string text_value(const Json& value, std::string_view key, std::string_view where) {
  if (!value.is_string())
    throw Error(ErrorCode::config, cat(where, ": \"", key, "\" is not a text in quotes: ", value.dump()));
  return value.get<std::string>();
}

bool is_identifier(std::string_view id) {
  const auto allowed = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; };
  return !id.empty() && std::all_of(id.begin(), id.end(), allowed);
}

std::string stage_id(const Json& json, const std::string& where) {
  if (!json.is_object())
    throw Error(ErrorCode::config, cat(where, ": is not an object: ", json.dump()), "write {\"id\": \"ao\", ...}");
  if (!json.contains("id"))
    throw Error(ErrorCode::config, cat(where, ": has no \"id\""), "every stage needs one, unique in its file");
  std::string id = text_value(json["id"], "id", where);
  if (!is_identifier(id))
    throw Error(ErrorCode::config, cat(where, ": \"", id, "\" is not an id"), "use letters, digits, _ and -");
  return id;
}

Entry parse_entry(const Json& json, const std::string& where, const std::string& label) {
  Entry entry;
  entry.id = stage_id(json, where);
  entry.where = cat(label, ": stage ", entry.id);
  for (const auto& [key, value] : json.items()) {
    if (key == "method") {
      entry.method = text_value(value, key, entry.where);
    } else if (key == "before") {
      entry.before = text_value(value, key, entry.where);
    } else if (key == "after") {
      entry.after = text_value(value, key, entry.where);
    } else if (key == "remove") {
      if (value != true)
        throw Error(ErrorCode::config, cat(entry.where, ": \"remove\" is not true: ", value.dump()),
                    "leave it out to keep the stage");
      entry.remove = true;
    } else if (key != "id") {
      entry.values[key] = value;
    }
  }
  if (entry.before && entry.after)
    throw Error(ErrorCode::config, cat(entry.where, ": has both \"before\" and \"after\""), "give one of them");
  if (entry.remove && json.size() > 2)
    throw Error(ErrorCode::config, cat(entry.where, ": is removed and yet has other keys"),
                "give \"id\" and \"remove\" only");
  return entry;
}

std::vector<std::string> ids_of(const Preset& preset) {
  std::vector<std::string> ids;
  for (const StageDescription& stage : preset.stages) ids.push_back(stage.id);
  return ids;
}

[[noreturn]] void unknown_stage(const Preset& preset, const std::string& id, std::string_view where) {
  const std::vector<std::string> ids = ids_of(preset);
  const std::string guess = did_you_mean(id, ids);
  const std::string all = ids.empty() ? "there are no stages" : "the stages are " + join(ids, ", ");
  throw Error(ErrorCode::config, cat(where, ": no stage \"", id, "\""), guess.empty() ? all : guess + " " + all);
}

auto find_stage(Preset& preset, std::string_view id) {
  return std::find_if(preset.stages.begin(), preset.stages.end(),
                      [&](const StageDescription& stage) { return stage.id == id; });
}

StageParams default_params(const std::string& method, std::string_view where) {
  std::optional<StageParams> found;
  std::vector<std::string> names;
  for_each_method([&]<class Params>(std::type_identity<Params>) {
    names.emplace_back(Params::method);
    if (Params::method == method) found = Params{};
  });
  if (found) return *found;
  const std::string guess = did_you_mean(method, names);
  throw Error(ErrorCode::config, cat(where, ": unknown method \"", method, "\""),
              guess.empty() ? "the methods are " + join(names, ", ") : guess);
}

void forget_origins(Resolved& base, const std::string& id) {
  std::erase_if(base.origins, [&](const auto& item) { return item.first.starts_with(id + "."); });
}

void set_defaults(Resolved& base, StageDescription& stage, StageParams params) {
  stage.params = std::move(params);
  forget_origins(base, stage.id);
  for (const params::Record& record : table_of(stage.params)) base.origins[stage.id + "." + record.key] = "default";
}

/// Finds the entry's stage or makes it, with the method that the entry asks for.
StageDescription& stage_for(Resolved& base, const Entry& entry) {
  auto stage = find_stage(base.preset, entry.id);
  if (stage == base.preset.stages.end()) {
    if (!entry.method)
      throw Error(ErrorCode::config, cat(entry.where, ": has no \"method\""),
                  base.preset.stages.empty()
                      ? "a new stage needs one"
                      : "a new stage needs one; inherited are " + join(ids_of(base.preset), ", "));
    StageParams params = default_params(*entry.method, entry.where);
    base.preset.stages.push_back({entry.id, params});
    set_defaults(base, base.preset.stages.back(), params);
    return base.preset.stages.back();
  }
  if (entry.method && *entry.method != method_of(stage->params))
    set_defaults(base, *stage, default_params(*entry.method, entry.where));
  return *stage;
}

void place(Preset& preset, const Entry& entry) {
  if (!entry.before && !entry.after) return;
  const std::string& anchor = entry.before ? *entry.before : *entry.after;
  if (anchor == entry.id) throw Error(ErrorCode::config, cat(entry.where, ": is placed beside itself"));
  if (find_stage(preset, anchor) == preset.stages.end()) unknown_stage(preset, anchor, entry.where);
  const auto from = find_stage(preset, entry.id);
  StageDescription stage = std::move(*from);
  preset.stages.erase(from);
  preset.stages.insert(find_stage(preset, anchor) + (entry.after ? 1 : 0), std::move(stage));
}

void check_keys(const Entry& entry, const params::Table& table) {
  std::vector<std::string> known(std::begin(kStageKeys), std::end(kStageKeys));
  for (const params::Record& record : table) known.push_back(record.key);
  for (const auto& [key, value] : entry.values.items())
    if (std::find(known.begin(), known.end(), key) == known.end()) params::unknown_key(key, known, entry.where);
}

void merge_entry(Resolved& base, const Entry& entry, const std::string& origin) {
  if (entry.remove) {
    const auto stage = find_stage(base.preset, entry.id);
    if (stage == base.preset.stages.end()) unknown_stage(base.preset, entry.id, entry.where);
    base.preset.stages.erase(stage);
    forget_origins(base, entry.id);
    return;
  }
  StageDescription& stage = stage_for(base, entry);
  check_keys(entry, table_of(stage.params));
  std::visit([&](auto& params) { params::read(params.table(), &params, entry.values, entry.where); }, stage.params);
  for (const auto& [key, value] : entry.values.items()) base.origins[entry.id + "." + key] = origin;
  place(base.preset, entry);
}

}  // namespace

void merge_file(Resolved& base, const Json& json, const std::string& label) {
  if (!json.is_object())
    throw Error(ErrorCode::config, cat(label, ": is not a JSON object"), "a preset is {\"stages\": [...]}");
  const std::vector<std::string> known{"$schema", "description", "extends", "stages"};
  for (const auto& [key, value] : json.items()) {
    if (std::find(known.begin(), known.end(), key) == known.end()) params::unknown_key(key, known, label);
    if (key != "stages") text_value(value, key, label);
  }
  base.preset.description = json.value("description", "");
  if (!json.contains("stages")) {
    if (json.contains("extends")) return;
    throw Error(ErrorCode::config, cat(label, ": has neither \"stages\" nor \"extends\""));
  }
  const Json& stages = json["stages"];
  if (!stages.is_array()) throw Error(ErrorCode::config, cat(label, ": \"stages\" is not a list in [ ]"));
  std::set<std::string> seen;
  for (size_t i = 0; i < stages.size(); ++i) {
    const Entry entry = parse_entry(stages[i], cat(label, ": stages[", i, "]"), label);
    if (!seen.insert(entry.id).second)
      throw Error(ErrorCode::config, cat(entry.where, ": the id is used twice"), "ids are unique in a file");
    merge_entry(base, entry, label);
  }
}

void merge_set(Resolved& base, std::string_view assignment) {
  const std::string label = cat("--set ", assignment);
  const size_t equals = assignment.find('='), dot = assignment.substr(0, equals).find('.');
  if (equals == std::string_view::npos || dot == std::string_view::npos)
    throw Error(ErrorCode::config, cat(label, ": is not of the form stage.key=value"),
                "for example --set ao.radius_m=1.5");
  const std::string id(assignment.substr(0, dot)), key(assignment.substr(dot + 1, equals - dot - 1));
  const std::string_view text = assignment.substr(equals + 1);
  const auto stage = find_stage(base.preset, id);
  if (stage == base.preset.stages.end()) unknown_stage(base.preset, id, label);
  Json json{{"id", id}};
  const params::Table& table = table_of(stage->params);
  const auto record = std::find_if(table.begin(), table.end(), [&](const params::Record& r) { return r.key == key; });
  if (record != table.end()) {
    json[key] = params::parse_value(*record, text, cat(label, ": stage ", id));
  } else {
    json[key] = key == "remove" && text == "true" ? Json(true) : Json(text);
  }
  merge_entry(base, parse_entry(json, label, label), "--set");
}

}  // namespace aftershade::preset
