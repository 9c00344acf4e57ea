#include "app/manual.h"

#include "app/help.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/metrics/sequence_scores.h"
#include "core/pipeline/aov.h"
#include "core/preset/preset.h"

namespace aftershade::app {

namespace {

/// Text as roff: backslashes, leading dots and hyphens in option names do what they should.
std::string roff(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if ((c == '.' || c == '\'') && out.empty()) out += "\\&";
    if (c == '-') out += '\\';
    out += c;
    if (c == '\\') out += 'e';
  }
  return out;
}

/// A default as prose has it: names without quotes, which would also end the macro's argument.
std::string default_text(const params::Record& record) {
  const params::Json& value = record.default_value;
  return value.is_string() ? value.get<std::string>() : value.dump();
}

const CommandText& command_named(const std::string& name) {
  for (const CommandText& command : command_texts())
    if (command.name == name) return command;
  throw Error(ErrorCode::internal, "no command " + name);
}

std::string bold(std::string_view text) { return cat("\\fB", roff(text), "\\fR"); }
std::string italic(std::string_view text) { return cat("\\fI", roff(text), "\\fR"); }

std::string man_options(const std::string& command) {
  std::string out;
  for (const OptionText& option : command_named(command).options) {
    std::vector<std::string> names;
    for (const std::string& name : split(option.names, ',')) names.push_back(bold(name));
    std::string head = option.names.starts_with('-') ? join(names, ", ") + " " : "";
    if (!option.value.empty()) head += italic(option.value);
    out += cat(".TP\n", head, "\n", roff(option.doc), ".\n");
  }
  return out;
}

std::string man_methods() {
  std::string out;
  for (const preset::MethodInfo& method : preset::methods()) {
    out += ".SS " + roff(method.method) + "\n" + roff(method.summary) + ".\n";
    for (const params::Record& record : *method.table)
      out += ".TP\n.BR " + roff(record.key) + " \" (" + roff(params::domain_text(record)) + "; default " +
             roff(default_text(record)) + ")\"\n" + roff(record.doc) + "\n";
  }
  return out;
}

std::string man_aovs() {
  std::string out;
  for (const pipeline::AovInfo& aov : pipeline::kAovs)
    out += cat(".TP\n", bold(aov.name), aov.is_vector ? " (.x, .y)" : "", "\n", roff(aov.doc), ".\n");
  return out;
}

std::string man_metrics() {
  std::string out;
  for (const metrics::MetricInfo& metric : metrics::metric_infos()) {
    const bool zero = metric.better == metrics::Better::zero;
    const std::string better = zero ? "near 0" : metric.better == metrics::Better::lower ? "low" : "high";
    out += cat(".TP\n.BR ", roff(metric.name), " \"", metric.unit.empty() ? "" : cat(" (", metric.unit, ")"), "\"\n",
               roff(metric.doc), "; good is ", better, ".\n");
  }
  return out;
}

std::string man_exit_status() {
  std::string out;
  for (const ExitText& exit : exit_texts()) out += ".TP\n.B " + exit.status + "\n" + roff(exit.meaning) + ".\n";
  return out;
}

std::string markdown_options(const std::string& command) {
  std::string out = "| option | what it does |\n| --- | --- |\n";
  for (const OptionText& option : command_named(command).options) {
    const bool positional = !option.names.starts_with('-');
    std::string name = positional
                           ? option.value
                           : join(split(option.names, ','), ", ") + (option.value.empty() ? "" : " " + option.value);
    std::string doc = option.doc;
    for (std::string* text : {&name, &doc})
      for (size_t at = 0; (at = text->find('|', at)) != std::string::npos; at += 2) text->insert(at, "\\");
    out += "| `" + name + "` | " + doc + " |\n";
  }
  return out;
}

}  // namespace

std::string generated_part(const std::string& name) {
  if (name == "aovs") return man_aovs();
  if (name == "methods") return man_methods();
  if (name == "metrics") return man_metrics();
  if (name == "exit status") return man_exit_status();
  const std::vector<std::string> words = split(name, ' ');
  if (words.size() == 2 && words[0] == "options") return man_options(words[1]);
  if (words.size() == 3 && words[0] == "options" && words[2] == "markdown") return markdown_options(words[1]);
  throw Error(ErrorCode::internal, cat("no generated part is called \"", name, "\""));
}

std::string with_generated_parts(const std::string& document) {
  constexpr std::string_view begin = "BEGIN GENERATED ", end = "END GENERATED";
  std::string out, name;
  for (const std::string& line : split(document, '\n')) {
    const size_t at = line.find(begin);
    if (at != std::string::npos) {
      name = line.substr(at + begin.size());
      if (name.ends_with(" -->")) name.resize(name.size() - 4);
      out += line + "\n" + generated_part(name);
    } else if (line.find(end) != std::string::npos) {
      name.clear();
    }
    if (name.empty()) out += line + "\n";
  }
  if (!out.empty()) out.pop_back();  // split() made one more line end than there was
  return out;
}

}  // namespace aftershade::app
