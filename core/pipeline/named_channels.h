#pragma once
#include <string>
#include <vector>

#include "core/pipeline/needs.h"
#include "core/pipeline/work.h"
#include "core/preset/preset.h"

/// Filters of the AO that can work on any channel of the file instead, a shadow AOV say: their parameter `channel` is
/// "" for the AO, or the channel's name without view. Such a stage adds needs_of_value() to its needs, reads value_of()
/// and gives its result to put_value().
namespace aftershade::pipeline {

/// The channels that the stages of a preset name, each once: io::SourceOptions::named_channels.
std::vector<std::string> named_channels(const preset::Preset& preset);

/// AO with its grid, or the named channel.
Needs needs_of_value(const std::string& channel);

/// As the stages before have left it: Work::ao (on its grid or at every pixel), or the named channel at every pixel.
ConstPlaneView value_of(const Work& work, const std::string& channel);

/// Takes the filtered value. In a named channel, which is written to the file, pixels without a surface and pixels that
/// are no numbers keep what they have to the bit.
void put_value(Work& work, const std::string& channel, Plane filtered);

}  // namespace aftershade::pipeline
