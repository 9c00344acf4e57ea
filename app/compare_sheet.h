#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.h"
#include "core/image/window.h"
#include "core/preview/sheet.h"
#include "core/report/worst_frames.h"

/// The contact sheet of `compare`: every preset's result and the reference, frame beside frame.
namespace aftershade::app {

/// What --sheet, --sheet-frames and --sheet-region ask for, validated.
struct SheetPlan {
  bool color = false;       ///< else AO
  std::vector<int> frames;  ///< rising
  Window region;            ///< absolute coordinates, inside the display window
  float pixel_aspect = 1;
};
/// Nothing without --sheet. `compared` are the frames of the comparison, in their order.
std::optional<SheetPlan> sheet_plan(const CompareArgs& args, const std::vector<int>& compared, Window display,
                                    float pixel_aspect);

class ComparisonSheet {
 public:
  /// Pictures have these names, in this order, and cover the display window.
  ComparisonSheet(SheetPlan plan, Window display, std::vector<std::string> names);

  bool wants(int number) const;
  bool shows_color() const { return plan_.color; }
  /// As many as names or more; one without planes leaves its place empty. Keeps a copy of the region. Throws
  /// Error(data) for a picture of another size than the display window.
  void add(int number, const std::vector<report::Pixels>& pictures);
  /// A row per name and a column per frame; of one frame, rows of three. Returns a note for the user, or "". Uses the
  /// sheet up; does nothing when no frame was added.
  std::string write(const std::string& png_path);

 private:
  SheetPlan plan_;
  Window display_;
  std::vector<std::string> names_;
  std::map<int, std::vector<preview::Cell>> cells_;
};

}  // namespace aftershade::app
