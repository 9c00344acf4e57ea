#pragma once
#include <string>

#include "app/commands.h"

/// The parts of the committed documents that come from the tables. A document holds them between lines
/// `BEGIN GENERATED name` and `END GENERATED`; tests/documents compares, and rewrites when asked to.
namespace aftershade::app {

/// The text of a generated part: "options render" and so on (man), "methods" (man), "exit status" (man), "options
/// render markdown", "presets markdown". Throws Error(internal) for an unknown name.
std::string generated_part(const std::string& name);

/// `document` with every generated part replaced by what the tables produce now.
std::string with_generated_parts(const std::string& document);

}  // namespace aftershade::app
