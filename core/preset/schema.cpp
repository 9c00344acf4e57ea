#include "core/base/text.h"
#include "core/preset/preset.h"

namespace aftershade::preset {

using params::Json;

namespace {

Json text_property(std::string_view description) { return {{"type", "string"}, {"description", description}}; }

Json id_property() {
  Json id = text_property("The stage's name, unique in the file: what --set and extends address.");
  id["pattern"] = "^[A-Za-z0-9_-]+$";
  return id;
}

/// A stage of one method. "method" may be missing: then the entry overrides keys of an inherited stage.
Json stage_schema(const MethodInfo& info) {
  Json properties{{"id", id_property()}, {"method", {{"const", info.method}, {"description", info.summary}}}};
  properties["before"] = text_property("Puts the stage before the one with this id.");
  properties["after"] = text_property("Puts the stage after the one with this id.");
  properties.update(params::schema_properties(*info.table));
  return {{"type", "object"},
          {"description", info.summary},
          {"properties", std::move(properties)},
          {"required", {"id"}},
          {"not", {{"required", {"before", "after"}}}},
          {"additionalProperties", false}};
}

Json removal_schema() {
  return {{"type", "object"},
          {"description", "Drops the inherited stage with this id."},
          {"properties", {{"id", id_property()}, {"remove", {{"const", true}}}}},
          {"required", {"id", "remove"}},
          {"additionalProperties", false}};
}

}  // namespace

Json schema() {
  Json definitions{{"remove", removal_schema()}}, alternatives = Json::array();
  for (const MethodInfo& info : methods()) definitions[std::string(info.method)] = stage_schema(info);
  for (const auto& [name, definition] : definitions.items())
    alternatives.push_back({{"$ref", "#/definitions/" + name}});
  Json properties{{"$schema", {{"type", "string"}}}};
  properties["description"] = text_property("What the preset is, for people.");
  properties["extends"] =
      text_property("The preset it builds on: a shipped name, or a .json file relative to this one.");
  properties["stages"] = {
      {"type", "array"},
      {"description", "The steps in their order; with extends, merged by id into the inherited ones."},
      {"items", {{"anyOf", std::move(alternatives)}}}};
  return {{"$schema", "http://json-schema.org/draft-07/schema#"},
          {"title", "aftershade preset"},
          {"type", "object"},
          {"properties", std::move(properties)},
          {"anyOf", {{{"required", {"stages"}}}, {{"required", {"extends"}}}}},
          {"additionalProperties", false},
          {"definitions", std::move(definitions)}};
}

}  // namespace aftershade::preset
