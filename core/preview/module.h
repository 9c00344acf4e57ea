#pragma once
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/color/display.h"
#include "core/preview/picture.h"
#include "core/preview/sheet.h"

/// What the program and the module aftershade-preview.so agree on. They are built together, and the version says so,
/// so plain C++ types may cross; exceptions may not: they cross as a value.
namespace aftershade::preview {

/// A finished PNG file, or the error; `note` is what the user should know.
struct EncodedSheet {
  std::vector<unsigned char> png;
  std::string note;
  std::optional<Error> error;
};

/// The one thing that the module exports, under the name kModuleSymbol. `threads` >= 1 is the limit for OpenImageIO.
struct ModuleTable {
  const char* version;  ///< of aftershade

  /// Filters `source` to the size of `target` (both not empty; numbers only): Mitchell's filter, edges repeated.
  void (*resize)(PlaneView source, PlaneView target, int threads, std::optional<Error>& error) noexcept;

  /// Draws the sheet; its pictures have their final size and values in 0..1, and are used up.
  void (*encode_sheet)(Sheet& sheet, int threads, EncodedSheet& out) noexcept;

  /// DisplayTransform's name and its apply(); transforms that were made once are kept. From any thread.
  void (*view_name)(const color::DisplayOptions& options, std::string& name, std::optional<Error>& error) noexcept;
  void (*to_display)(std::span<const PlaneView, 3> rgb, const color::DisplayOptions& options,
                     std::optional<Error>& error) noexcept;

  /// A PNG file of the picture, which is not empty. From any thread.
  void (*encode_png)(const Picture& picture, std::vector<unsigned char>& png, std::optional<Error>& error) noexcept;
};
inline constexpr char kModuleSymbol[] = "aftershade_preview_module";

/// Where the module may be: beside the executable (a build), else in the library folder of an installation.
std::vector<std::filesystem::path> module_candidates();

/// Opens the first of `candidates` that exists, for the rest of the process. Throws Error(internal) when there is none,
/// when it cannot be loaded, or when it belongs to another version of the program.
const ModuleTable& open_module(std::span<const std::filesystem::path> candidates);

/// open_module(module_candidates()), on the first call.
const ModuleTable& loaded_module();

}  // namespace aftershade::preview
