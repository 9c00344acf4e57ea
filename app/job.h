#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/commands.h"
#include "core/io/file_source.h"
#include "core/pipeline/pipeline.h"
#include "core/preset/preset.h"

/// What will be done, resolved from what was typed and validated before frame 1.
namespace aftershade::app {

/// An input sequence, opened: profile, camera, channels by role, and the frames asked for.
struct Input {
  io::FoundSequence found;
  std::vector<int> frames;             ///< the frames asked for that exist, sorted
  std::vector<int> holes;              ///< the frames asked for that do not
  std::vector<io::Sequence> siblings;  ///< of --role
  io::Detected producer;
  std::string unit;  ///< "m" ..., and where it comes from
  std::string unit_origin;
  std::unique_ptr<io::FileSource> source;
  std::vector<std::string> views;
};

/// The meaning of --hash-digits "one" or "oiio".
io::HashDigits hash_digits(const std::string& name);

/// Opens INPUT; `named_channels` are those that stages filter. Throws for everything that is wrong with it; holes are
/// an error unless --missing skip.
Input open_input(const InputArgs& args, const std::vector<std::string>& named_channels = {});

/// What the AO is called in a file that already has a channel AO.
inline constexpr const char* kOwnAoChannel = "aftershade.AO";

/// Does a view of the file have this channel, its view token aside?
bool has_channel(const io::FileInfo& info, const std::string& view, const std::string& name);

/// What the AO is called in files made from one like this: "AO", or kOwnAoChannel where any view has either.
std::string ao_channel_for(const io::FileInfo& info);

/// What the first frame of a view offers to the stages.
pipeline::Offer offer_of(const Input& input, const std::string& view);

/// The preset, changed by --set, reduced by --only and --skip.
preset::Resolved resolve_preset(const PresetArgs& args);

/// The number of frames that --preroll means; Error(usage) when it is none.
int preroll_of(const std::string& text);

/// Refuses (Error(usage)) to write over a frame that is read, under whatever name.
void check_not_input(const Input& input, const std::vector<int>& written,
                     const std::function<std::string(int)>& output_path);

/// Throws Error(cannot_create) unless the folder of `path` exists and can be written to.
void check_folder(const std::string& path);

/// Frames to write and where.
struct Job {
  Input input;
  preset::Resolved preset;    ///< without stages: --recode
  size_t named_channels = 0;  ///< channels that its stages filter
  std::vector<pipeline::ViewPipeline> views;
  std::vector<int> written;
  std::function<std::string(int)> output_path;
  io::WriteOptions write;
  int preroll = 40;
  bool keep_file = false;       ///< frames carry the decoded bytes of their files to where they are written
  size_t frames_in_flight = 1;  ///< in memory at once
};
Job resolve_job(const RenderArgs& args);

}  // namespace aftershade::app
