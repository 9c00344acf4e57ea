#pragma once
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/params/table.h"
#include "core/preset/methods.h"

namespace aftershade::preset {

/// One step of a preset: its id is unique in the preset and is what --set and `extends` address.
struct StageDescription {
  std::string id;
  StageParams params;
  bool operator==(const StageDescription&) const = default;
};

/// An ordered list of stages; a value equal to its JSON (aftershade-preset(5)).
struct Preset {
  std::string name, description;
  std::vector<StageDescription> stages;
  bool operator==(const Preset&) const = default;
};

/// A preset with the origin of every value: "ao.radius_m" -> "default", "high-dx11", "my.json" or "--set".
struct Resolved {
  Preset preset;
  std::map<std::string, std::string> origins;
};

/// Names of the shipped presets, sorted.
std::vector<std::string> shipped_presets();

/// A shipped preset by name or a .json file (a text with '/' or ending in .json is a file), its `extends` chain
/// followed, then `sets` ("ao.radius_m=1.5") applied. Throws Error(config): unknown preset, stage, method or key with
/// "did you mean", wrong type, out of range, extends in a circle, the same id twice; Error(no_input) for a file that
/// cannot be read.
Resolved load_preset(const std::string& name_or_file, const std::vector<std::string>& sets = {});

/// Every parameter of every stage, nothing inherited: complete in itself. The name is not part of it.
params::Json to_json(const Preset& preset);
/// A preset file's content; `where` names the file in messages, is what "extends" is relative to, and gives the name
/// (without folder and .json). from_json(to_json(p), p.name) == p. Throws as load_preset.
Preset from_json(const params::Json& json, std::string_view where);

/// Lines "ao.radius_m: 1 -> 1.5" of all that differs, in stage order; also stages that only one has.
std::vector<std::string> difference(const Preset& a, const Preset& b);

/// JSON Schema (draft 7) of a preset file.
params::Json schema();

/// A method's name, one-line summary and parameters: for help, manual and README.
struct MethodInfo {
  std::string_view method, summary;
  const params::Table* table;
};
std::vector<MethodInfo> methods();
const params::Table& table_of(const StageParams& params);
/// The parameter struct inside `params`: what the records of table_of(params) read, as record.get(values_of(params)).
const void* values_of(const StageParams& params);
std::string_view method_of(const StageParams& params);

}  // namespace aftershade::preset
