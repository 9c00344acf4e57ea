#include "tests/bench/throughput/rows.h"

#include <cstdio>

#include "core/base/text.h"

namespace aftershade::tests::throughput {

namespace {

std::string number(const std::optional<double>& value) {
  if (!value) return "";
  return fixed(*value, *value < 20 ? 3 : 1);
}

const char* reached(const Row& row) {
  if (!row.value) return "not measured";
  if (row.goal.kind == Goal::none) return "-";
  return row.goal.reached(*row.value) ? "yes" : "no";
}

}  // namespace

std::string Goal::text() const {
  if (kind == none) return "";
  return cat(kind == at_most ? "<= " : ">= ", bound);
}

void print(const std::vector<Row>& rows) {
  std::printf("\n  %-62s %9s %-3s %9s %-9s %-13s %s\n", "measure", "value", "", "(by CPU)", "goal", "reached", "note");
  for (const Row& row : rows)
    std::printf("  %-62s %9s %-3s %9s %-9s %-13s %s\n", row.measure.c_str(), number(row.value).c_str(),
                row.unit.c_str(), number(row.by_cpu).c_str(), row.goal.text().c_str(), reached(row), row.note.c_str());
}

params::Json to_json(const std::vector<Row>& rows) {
  params::Json out = params::Json::array();
  for (const Row& row : rows) {
    params::Json& json = out.emplace_back(params::Json{{"measure", row.measure}, {"reached", reached(row)}});
    if (!row.unit.empty()) json["unit"] = row.unit;
    if (row.value) json["value"] = *row.value;
    if (row.by_cpu) json["by_cpu"] = *row.by_cpu;
    if (row.goal.kind != Goal::none) json["goal"] = row.goal.text();
    if (!row.note.empty()) json["note"] = row.note;
  }
  return out;
}

}  // namespace aftershade::tests::throughput
