#include "app/mask.h"

#include "app/log.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/channel_names.h"
#include "core/io/roles.h"

namespace aftershade::app {

namespace {
constexpr std::string_view kCryptomatte = "cryptomatte:";

io::ChannelRef alpha_of(const io::ExrReader& file, const Input& input, const std::string& view) {
  for (const io::ColorBinding& color : input.source->layers(view))
    if (color.is_beauty && color.alpha >= 0) return color.channels[static_cast<size_t>(color.alpha)];
  throw Error(ErrorCode::no_input, cat("the colour of ", file.info().path, " has no alpha"),
              "--mask CHANNEL names another channel, --mask-from another sequence");
}
}  // namespace

MaskReader::MaskReader(const std::string& spec, const Input& input, const std::string& view)
    : sequence_(input.found.sequence), view_(view) {
  const io::ExrReader file(*sequence_.path(input.frames.front()));
  with_context("--mask " + spec, [&] {
    if (spec.starts_with(kCryptomatte)) {
      object_ = spec.substr(kCryptomatte.size());
      io::find_cryptomatte(file, view, *object_);
    } else {
      channel_ = spec == "alpha" ? alpha_of(file, input, view) : io::find_channel(file.info(), view, spec);
    }
  });
}

Plane MaskReader::load(int frame) const {
  Plane mask = read(frame);
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x)
      if (mask(x, y) > 0.5F) return mask;
  log().warning(cat("frame ", frame, ": the mask selects no pixel of ", *sequence_.path(frame)));
  return mask;
}

Plane MaskReader::read(int frame) const {
  const std::string* path = sequence_.path(frame);
  if (!path)
    throw Error(ErrorCode::no_input, cat("--mask: the sequence has no frame ", frame),
                "it has " + io::format_frames(sequence_.frames()));
  const io::ExrReader file(*path);
  const Window display = file.info().display_window;
  if (object_) return io::cryptomatte_coverage(file, io::find_cryptomatte(file, view_, *object_), display);
  Plane mask(display.width(), display.height());
  const io::ExrReader::Request requests[] = {{channel_->channel, mask}};
  file.read(channel_->part, requests, display);
  return mask;
}

}  // namespace aftershade::app
