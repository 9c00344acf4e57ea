#include "core/preview/loader.h"

#include <dlfcn.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/publish.h"
#include "core/parallel/rows.h"
#include "core/preview/module.h"
#include "core/preview/sheet_layout.h"

namespace aftershade::preview {

namespace fs = std::filesystem;

namespace {

constexpr char kModuleFile[] = "aftershade-preview.so";
constexpr char kHint[] = "reinstall aftershade; the module belongs beside the program or in the library folder";

void check(const Cell& cell) {
  const auto& planes = cell.planes;
  const auto differs = [&](const Plane& plane) {
    return plane.width() != planes[0].width() || plane.height() != planes[0].height();
  };
  if ((planes.size() != 0 && planes.size() != 1 && planes.size() != 3) ||
      std::any_of(planes.begin(), planes.end(), differs))
    throw Error(ErrorCode::usage, cat("the picture \"", cell.label, "\" has neither one nor three planes of one size"));
  if (!(cell.pixel_aspect > 0 && std::isfinite(cell.pixel_aspect)))
    throw Error(ErrorCode::usage, cat("the picture \"", cell.label, "\" has a pixel aspect of ", cell.pixel_aspect));
}

/// A comparison with NaN is false, so NaN becomes 0.
void clamp(PlaneView plane) {
  for (int y = 0; y < plane.height; ++y)
    for (int x = 0; x < plane.width; ++x) plane(x, y) = plane(x, y) > 0 ? std::min(plane(x, y), 1.0F) : 0.0F;
}

void resize(Plane& plane, PixelSize size) {
  Plane out(size.width, size.height);
  std::optional<Error> error;
  loaded_module().resize(plane, out, thread_count(), error);
  if (error) throw Error(*error);
  plane = std::move(out);
}

}  // namespace

std::vector<fs::path> module_candidates() {
  std::error_code ignored;
  const fs::path folder = fs::read_symlink("/proc/self/exe", ignored).parent_path();
  return {folder / kModuleFile, folder / AFTERSHADE_MODULE_FOLDER / kModuleFile};
}

const ModuleTable& open_module(std::span<const fs::path> candidates) {
  std::error_code ignored;
  const auto found =
      std::find_if(candidates.begin(), candidates.end(), [&](const auto& p) { return fs::exists(p, ignored); });
  if (found == candidates.end()) {
    std::vector<std::string> tried;
    for (const auto& path : candidates) tried.push_back(path.lexically_normal().string());
    throw Error(ErrorCode::internal, cat("the preview module is missing: there is no ", join(tried, " and no ")),
                kHint);
  }
  void* const handle = dlopen(found->c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) throw Error(ErrorCode::internal, cat("cannot load the preview module: ", dlerror()), kHint);
  const auto* table = static_cast<const ModuleTable*>(dlsym(handle, kModuleSymbol));
  if (table == nullptr || std::strcmp(table->version, AFTERSHADE_VERSION) != 0)
    throw Error(ErrorCode::internal,
                cat(found->string(), " is not the preview module of aftershade ", AFTERSHADE_VERSION), kHint);
  return *table;
}

const ModuleTable& loaded_module() {
  static const ModuleTable& table = open_module(module_candidates());
  return table;
}

void shrink(Cell& cell, const SheetStyle& style) {
  check(cell);
  if (cell.planes.empty() || cell.planes[0].empty()) return;
  const PixelSize size{cell.planes[0].width(), cell.planes[0].height()};
  const PixelSize target = fitted(size, cell.pixel_aspect, {style.max_cell_width_px, style.max_cell_height_px});
  for (Plane& plane : cell.planes) {
    clamp(plane);
    if (size != target) resize(plane, target);
    clamp(plane);  // the filter has negative lobes
  }
  cell.pixel_aspect = 1;
}

std::string write_sheet(Sheet sheet, const std::string& png_path) {
  for (auto& row : sheet.rows)
    for (Cell& cell : row) shrink(cell, sheet.style);
  const auto has_picture = [](const Cell& cell) { return !cell.planes.empty() && !cell.planes[0].empty(); };
  if (std::none_of(sheet.rows.begin(), sheet.rows.end(),
                   [&](const auto& row) { return std::any_of(row.begin(), row.end(), has_picture); }))
    throw Error(ErrorCode::usage, "a contact sheet needs at least one picture");
  EncodedSheet encoded;
  loaded_module().encode_sheet(sheet, thread_count(), encoded);
  if (encoded.error) throw Error(*encoded.error);
  io::publish({reinterpret_cast<const char*>(encoded.png.data()), encoded.png.size()}, png_path);
  return encoded.note;
}

}  // namespace aftershade::preview
