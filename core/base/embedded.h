#pragma once
#include <span>
#include <string_view>

namespace aftershade {

/// A file of the project (configs/, the report's page) that the build put into the program.
struct EmbeddedFile {
  std::string_view name;  ///< file name without folder and extension
  std::string_view text;
};

}  // namespace aftershade
