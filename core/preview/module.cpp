#include "core/preview/module.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <map>
#include <mutex>
#include <new>

#include "core/base/text.h"
#include "core/color/display.h"
#include "core/preview/sheet_layout.h"
#include "core/preview/text.h"

namespace aftershade::preview {

namespace {

constexpr int kMaxSide_px = 65500;
/// Display value of the background: neutral and dark, so that it sways neither colour nor the eye's exposure.
constexpr float kBackground = 0.12F;

/// Runs `work`; what it throws becomes the value `error`.
template <class Work>
void guarded(std::optional<Error>& error, Work&& work) noexcept {
  try {
    work();
  } catch (const Error& e) {
    error = e;
  } catch (const std::bad_alloc&) {
    error = Error(ErrorCode::memory, "not enough memory for the picture", "choose fewer frames or smaller cells");
  } catch (const std::exception& e) {
    error = Error(ErrorCode::internal, e.what());
  }
}

[[noreturn]] void fail(std::string_view what, const std::string& why) {
  throw Error(ErrorCode::internal, cat("OpenImageIO cannot ", what, ": ", why));
}

/// OpenImageIO's view of a plane. It declares what it reads as writable.
OIIO::ImageBuf wrapped(PlaneView plane) {
  constexpr auto kFloatBytes = static_cast<OIIO::stride_t>(sizeof(float));
  return OIIO::ImageBuf(OIIO::ImageSpec(plane.width, plane.height, 1, OIIO::TypeDesc::FLOAT), plane.data, kFloatBytes,
                        plane.stride * kFloatBytes);
}

void resize(PlaneView source, PlaneView target, int threads, std::optional<Error>& error) noexcept {
  guarded(error, [&] {
    OIIO::ImageBuf out = wrapped(target);
    if (!OIIO::ImageBufAlgo::resize(out, wrapped(source), "mitchell", 0.0F, {}, threads))
      fail("scale a picture", out.geterror());
  });
}

struct Lettering {
  std::optional<std::string> font;  ///< nullopt: no text
  int title_height_px = 0, label_height_px = 0;
  std::string note;
};

bool has_labels(const Sheet& sheet) {
  const auto labelled = [](const Cell& cell) { return !cell.label.empty() || !cell.legend.empty(); };
  return std::any_of(sheet.rows.begin(), sheet.rows.end(),
                     [&](const auto& row) { return std::any_of(row.begin(), row.end(), labelled); });
}

Lettering lettering_of(const Sheet& sheet) {
  const SheetStyle& style = sheet.style;
  const bool labels = has_labels(sheet), title = !sheet.title.empty();
  if (!labels && !title) return {};
  Lettering out;
  out.font = usable_font(style.font);
  if (!out.font) {
    out.note = cat("the sheet has no labels: the font ", style.font.empty() ? "DejaVu Sans" : style.font,
                   " cannot be used (install fonts-dejavu-core)");
    return out;
  }
  if (title) out.title_height_px = style.title_size_px * 3 / 2;
  if (labels) out.label_height_px = style.label_size_px * 7 / 4;
  return out;
}

/// A line of a legend: a square patch of its colour with a gap of half its side around it, and text.
int legend_line_px(const SheetStyle& style) { return style.label_size_px * 2; }

PixelSize size_of(const std::vector<LegendLine>& legend, const SheetStyle& style, const std::string& font) {
  int width = 0;
  for (const LegendLine& line : legend)
    width = std::max(width, legend_line_px(style) + text_width(line.text, style.label_size_px, font));
  return {std::min(width, style.max_cell_width_px), legend_line_px(style) * static_cast<int>(legend.size())};
}

CellSize size_of(const Cell& cell, const SheetStyle& style, const Lettering& lettering) {
  CellSize out;
  if (!cell.planes.empty()) out.picture = {cell.planes[0].width(), cell.planes[0].height()};
  if (lettering.font && cell.planes.empty()) out.picture = size_of(cell.legend, style, *lettering.font);
  if (lettering.font)
    out.label_width_px =
        std::min(text_width(cell.label, style.label_size_px, *lettering.font), style.max_cell_width_px);
  return out;
}

SheetLayout layout_of(const Sheet& sheet, const Lettering& lettering) {
  std::vector<std::vector<CellSize>> rows;
  for (const auto& row : sheet.rows) {
    auto& sizes = rows.emplace_back();
    for (const Cell& cell : row) sizes.push_back(size_of(cell, sheet.style, lettering));
  }
  SheetLayout layout = lay_out(rows, {sheet.style.gap_px, lettering.title_height_px, lettering.label_height_px});
  if (layout.sheet.width > kMaxSide_px || layout.sheet.height > kMaxSide_px)
    throw Error(ErrorCode::usage,
                cat("the sheet would have ", layout.sheet.width, " x ", layout.sheet.height, " pixels"),
                "choose fewer frames or smaller cells");
  return layout;
}

void draw_legend(OIIO::ImageBuf& canvas, const Box& box, const std::vector<LegendLine>& legend, const SheetStyle& style,
                 const std::string& font) {
  const int line_px = legend_line_px(style), patch_px = line_px / 2, gap_px = (line_px - patch_px) / 2;
  int y = box.y;
  for (const LegendLine& line : legend) {
    const OIIO::ROI patch(box.x, box.x + patch_px, y + gap_px, y + gap_px + patch_px, 0, 1, 0, 3);
    OIIO::ImageBufAlgo::fill(canvas, {line.color.r, line.color.g, line.color.b}, patch);
    draw_text(canvas, {box.x + line_px, y, box.width - line_px, line_px}, line.text, style.label_size_px, font);
    y += line_px;
  }
}

void draw_picture(OIIO::ImageBuf& canvas, const Box& box, Cell& cell) {
  std::vector<Plane>& planes = cell.planes;
  if (planes.empty()) return;
  const bool rgb = planes.size() == 3;
  if (rgb && !cell.is_display) color::to_display(std::array<PlaneView, 3>{planes[0], planes[1], planes[2]});
  for (int y = 0; y < box.height; ++y) {
    auto* pixel = static_cast<unsigned char*>(canvas.pixeladdr(box.x, box.y + y));
    for (int x = 0; x < box.width; ++x)
      for (const size_t plane : {0U, 1U, 2U})
        *pixel++ = static_cast<unsigned char>(planes[rgb ? plane : 0](x, y) * 255.0F + 0.5F);
  }
}

OIIO::ImageBuf drawn(Sheet& sheet, const Lettering& lettering) {
  const SheetLayout layout = layout_of(sheet, lettering);
  OIIO::ImageBuf canvas(OIIO::ImageSpec(layout.sheet.width, layout.sheet.height, 3, OIIO::TypeDesc::UINT8));
  OIIO::ImageBufAlgo::fill(canvas, {kBackground, kBackground, kBackground});
  if (lettering.font) draw_text(canvas, layout.title, sheet.title, sheet.style.title_size_px, *lettering.font);
  for (size_t row = 0; row < sheet.rows.size(); ++row)
    for (size_t column = 0; column < sheet.rows[row].size(); ++column) {
      Cell& cell = sheet.rows[row][column];
      const PlacedCell& place = layout.rows[row][column];
      draw_picture(canvas, place.picture, cell);
      if (lettering.font && cell.planes.empty())
        draw_legend(canvas, place.picture, cell.legend, sheet.style, *lettering.font);
      if (lettering.font) draw_text(canvas, place.label, cell.label, sheet.style.label_size_px, *lettering.font);
      cell.planes.clear();
    }
  return canvas;
}

/// `pixels` are as spec says.
std::vector<unsigned char> png_of(OIIO::ImageSpec spec, const void* pixels) {
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const auto output = OIIO::ImageOutput::create("png");
  if (!output || !output->supports("ioproxy")) fail("write PNG", OIIO::geterror());
  spec.attribute("oiio:ColorSpace", "sRGB");
  output->set_ioproxy(&memory);
  const bool written = output->open("picture.png", spec) && output->write_image(spec.format, pixels);
  if (!written || !output->close()) fail("write PNG", output->geterror());
  return bytes;
}

void encode_sheet(Sheet& sheet, int threads, EncodedSheet& out) noexcept {
  guarded(out.error, [&] {
    OIIO::attribute("threads", threads);
    const Lettering lettering = lettering_of(sheet);
    out.note = lettering.note;
    const OIIO::ImageBuf canvas = drawn(sheet, lettering);
    out.png = png_of(canvas.spec(), canvas.localpixels());
  });
}

/// Transforms are made once: ACES takes tens of milliseconds.
const color::DisplayTransform& transform_of(const color::DisplayOptions& options) {
  static std::mutex mutex;
  static std::map<std::pair<std::string, std::string>, color::DisplayTransform> made;
  const std::lock_guard lock(mutex);
  const std::pair key(options.ocio, options.view);
  if (const auto found = made.find(key); found != made.end()) return found->second;
  return made.emplace(key, color::DisplayTransform(options)).first->second;
}

void name_of_view(const color::DisplayOptions& options, std::string& name, std::optional<Error>& error) noexcept {
  guarded(error, [&] { name = transform_of(options).name(); });
}

void to_display(std::span<const PlaneView, 3> rgb, const color::DisplayOptions& options,
                std::optional<Error>& error) noexcept {
  guarded(error, [&] { transform_of(options).apply(rgb); });
}

bool is_grey(const Picture& picture) {
  for (size_t i = 0; i + 2 < picture.rgb.size(); i += 3)
    if (picture.rgb[i] != picture.rgb[i + 1] || picture.rgb[i] != picture.rgb[i + 2]) return false;
  return true;
}

void encode_png(const Picture& picture, std::vector<unsigned char>& png, std::optional<Error>& error) noexcept {
  guarded(error, [&] {
    const bool grey = is_grey(picture);
    std::vector<unsigned char> one;
    for (size_t i = 0; grey && i < picture.rgb.size(); i += 3) one.push_back(picture.rgb[i]);
    const OIIO::ImageSpec spec(picture.width, picture.height, grey ? 1 : 3, OIIO::TypeDesc::UINT8);
    png = png_of(spec, grey ? one.data() : picture.rgb.data());
  });
}

}  // namespace

}  // namespace aftershade::preview

extern "C" __attribute__((visibility("default")))
const aftershade::preview::ModuleTable aftershade_preview_module = {AFTERSHADE_VERSION,
                                                                    aftershade::preview::resize,
                                                                    aftershade::preview::encode_sheet,
                                                                    aftershade::preview::name_of_view,
                                                                    aftershade::preview::to_display,
                                                                    aftershade::preview::encode_png};
