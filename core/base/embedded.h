#pragma once
#include <span>
#include <string_view>

namespace aftershade {

/// A file of configs/ that the build put into the program.
struct EmbeddedFile {
  std::string_view name;  ///< file name without folder and ".json"
  std::string_view text;
};

}  // namespace aftershade
