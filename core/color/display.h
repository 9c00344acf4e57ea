#pragma once
#include <memory>
#include <span>
#include <string>

#include "core/image/plane.h"

namespace aftershade::color {

/// Which of OpenColorIO's view transforms brings pictures to the display.
struct DisplayOptions {
  std::string ocio{};  ///< a configuration (.ocio, .ocioz) file; "": the built-in one. $OCIO is never read
  std::string view{};  ///< name of a view; "": the configuration's default view of its default display
  bool operator==(const DisplayOptions&) const = default;
};

/// Turns scene-linear pixels into the values that a display takes, 0..1.
///
/// The built-in configuration takes pixels as linear Rec.709 and has three views for an sRGB display:
/// "sRGB" (default), what to_display() does and what display-referred metrics compare; "ACES 1.0 SDR", the tone mapping
/// of ACES 1.0's SDR video output transform; "Raw", the numbers themselves, clamped.
/// With a configuration file pixels are taken to be in its role scene_linear. A view is named "VIEW", of the default
/// display or else of the first display that has it, or "DISPLAY/VIEW".
class DisplayTransform {
 public:
  /// Throws Error(no_input): no such file; Error(config): a file that is no usable configuration;
  /// Error(usage): no such view (the hint lists those there are).
  explicit DisplayTransform(const DisplayOptions& options);

  /// "sRGB", or "DISPLAY/VIEW (FILE)" with the file's name: for reports.
  const std::string& name() const { return name_; }

  /// In place; the three planes have one size. NaN becomes 0 and infinities 65504 before, so nothing else can reach the
  /// transform; results are clamped to 0..1.
  void apply(std::span<const PlaneView, 3> rgb) const;

 private:
  struct Processor;
  std::shared_ptr<const Processor> processor_;
  std::string name_;
};

/// Turns red, green and blue in place from scene-linear Rec.709 into the values an sRGB display takes, 0..1.
/// The three planes have one size. Values are clamped to 0..1 first (no tone mapping: a picture shows what a viewer
/// with a plain sRGB display transform shows); NaN becomes 0. The curve is OpenColorIO's ExponentWithLinear with
/// gamma 2.4 and offset 0.055: the sRGB curve of IEC 61966-2-1 to within 1e-5, its linear piece being made to meet the
/// other smoothly. OpenColorIO is asked for the transform itself, never for a named space of a configuration, so $OCIO
/// changes nothing.
void to_display(std::span<const PlaneView, 3> rgb);

}  // namespace aftershade::color
