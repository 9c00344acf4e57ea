#include "core/preset/preset.h"

namespace aftershade::preset {

using params::Json;

const params::Table& table_of(const StageParams& params) {
  return std::visit([](const auto& p) -> const params::Table& { return p.table(); }, params);
}

const void* values_of(const StageParams& params) {
  return std::visit([](const auto& p) { return static_cast<const void*>(&p); }, params);
}

std::string_view method_of(const StageParams& params) {
  return std::visit([](const auto& p) { return p.method; }, params);
}

std::vector<MethodInfo> methods() {
  std::vector<MethodInfo> out;
  for_each_method([&]<class Params>(std::type_identity<Params>) {
    out.push_back({Params::method, Params::summary, &Params::table()});
  });
  return out;
}

Json to_json(const Preset& preset) {
  Json stages = Json::array();
  for (const StageDescription& stage : preset.stages) {
    Json entry{{"id", stage.id}, {"method", method_of(stage.params)}};
    entry.update(params::write(table_of(stage.params), values_of(stage.params)));
    stages.push_back(std::move(entry));
  }
  return {{"description", preset.description}, {"stages", std::move(stages)}};
}

}  // namespace aftershade::preset
