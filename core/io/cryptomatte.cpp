#include "core/io/cryptomatte.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/base/error.h"
#include "core/base/text.h"

namespace aftershade::io {

namespace {

/// What a header declares under "cryptomatte/KEY/".
struct Layer {
  std::string name, hash, conversion;
  std::optional<std::string> manifest;
};

std::vector<Layer> layers_of(const ExrReader& file) {
  std::vector<Layer> layers;
  for (int part = 0; part < static_cast<int>(file.info().parts.size()); ++part)
    for (const std::string& attribute : file.attribute_names(part)) {
      if (!glob_match("cryptomatte/*/name", attribute)) continue;
      const std::string stem = attribute.substr(0, attribute.rfind('/') + 1);
      const auto text = [&](const char* key) { return file.text(part, stem + key); };
      Layer layer{text("name").value_or(""), text("hash").value_or(""), text("conversion").value_or(""),
                  text("manifest")};
      const bool known =
          std::any_of(layers.begin(), layers.end(), [&](const Layer& other) { return other.name == layer.name; });
      if (!layer.name.empty() && !known) layers.push_back(std::move(layer));
    }
  return layers;
}

/// The names in a layer's manifest, {"name": "hexadecimal hash", ...}; none without one.
std::vector<std::string> manifest_names(const Layer& layer) {
  if (!layer.manifest) return {};
  const auto json = nlohmann::json::parse(*layer.manifest, nullptr, false);
  if (!json.is_object())
    throw Error(ErrorCode::data, cat("the manifest of the Cryptomatte \"", layer.name, "\" is no JSON object"));
  std::vector<std::string> names;
  for (const auto& item : json.items()) names.push_back(item.key());
  return names;
}

struct Found {
  const Layer* layer;
  std::string name;
};

Found find_object(const std::vector<Layer>& layers, const std::string& object) {
  std::vector<std::string> known, holders;
  std::optional<Found> found;
  for (const Layer& layer : layers) {
    const std::vector<std::string> names = manifest_names(layer);
    if (object.starts_with(layer.name + "/")) {
      const std::string name = object.substr(layer.name.size() + 1);
      if (names.empty() || std::find(names.begin(), names.end(), name) != names.end()) return {&layer, name};
      throw Error(ErrorCode::no_input, cat("Cryptomatte ", layer.name, " has no object \"", name, "\""),
                  did_you_mean(name, names));
    }
    known.insert(known.end(), names.begin(), names.end());
    if (std::find(names.begin(), names.end(), object) == names.end()) continue;
    holders.push_back(layer.name);
    found = {&layer, object};
  }
  if (holders.size() > 1)
    throw Error(ErrorCode::usage, cat("several Cryptomattes have an object \"", object, "\": ", join(holders, ", ")),
                cat("write ", holders.front(), "/", object));
  if (found) return *found;
  if (layers.size() == 1 && known.empty()) return {&layers.front(), object};
  std::vector<std::string> names;
  for (const Layer& layer : layers) names.push_back(layer.name);
  const std::string guess = did_you_mean(object, known);
  throw Error(ErrorCode::no_input, cat("no Cryptomatte has an object \"", object, "\""),
              guess.empty() ? "the file's Cryptomattes are " + join(names, ", ") : guess);
}

/// The channel of a rank's layer with one of the suffixes, in any case.
std::optional<ChannelRef> channel(const ViewChannels& channels, const std::string& layer,
                                  std::initializer_list<std::string_view> suffixes) {
  for (const NamedChannel& channel : channels.all())
    for (const std::string_view suffix : suffixes)
      if (to_lower(channel.name) == to_lower(layer) + "." + std::string(suffix)) return channel.ref;
  return std::nullopt;
}

std::vector<CryptomatteObject::Rank> ranks_of(const ViewChannels& channels, const std::string& layer) {
  std::vector<CryptomatteObject::Rank> ranks;
  for (int i = 0; i < 100; ++i) {
    const std::string name = cat(layer, i < 10 ? "0" : "", i);
    const auto r = channel(channels, name, {"r", "red"}), g = channel(channels, name, {"g", "green"});
    const auto b = channel(channels, name, {"b", "blue"}), a = channel(channels, name, {"a", "alpha"});
    if (r && g) ranks.push_back({*r, *g});
    if (b && a) ranks.push_back({*b, *a});
    if (!r && !b) break;
  }
  return ranks;
}

}  // namespace

uint32_t murmur3(std::string_view text) {
  constexpr uint32_t kFirst = 0xcc9e2d51, kSecond = 0x1b873593;
  uint32_t hash = 0;
  const auto mix = [](uint32_t block) { return std::rotl(block * kFirst, 15) * kSecond; };
  for (size_t at = 0; at < text.size(); at += 4) {
    uint32_t block = 0;
    const size_t size = std::min<size_t>(4, text.size() - at);
    for (size_t i = 0; i < size; ++i)
      block |= static_cast<uint32_t>(static_cast<unsigned char>(text[at + i])) << (8 * i);
    hash ^= mix(block);
    if (size == 4) hash = std::rotl(hash, 13) * 5 + 0xe6546b64;
  }
  hash ^= static_cast<uint32_t>(text.size());
  hash = (hash ^ (hash >> 16)) * 0x85ebca6b;
  hash = (hash ^ (hash >> 13)) * 0xc2b2ae35;
  return hash ^ (hash >> 16);
}

float cryptomatte_id(std::string_view name) {
  uint32_t bits = murmur3(name);
  const uint32_t exponent = (bits >> 23) & 255;
  if (exponent == 0 || exponent == 255) bits ^= 1U << 23;
  return std::bit_cast<float>(bits);
}

CryptomatteObject find_cryptomatte(const ExrReader& file, const std::string& view, const std::string& object) {
  const std::vector<Layer> layers = layers_of(file);
  if (layers.empty())
    throw Error(ErrorCode::no_input, cat(file.info().path, " has no Cryptomatte"),
                "its header has no attribute cryptomatte/*/name");
  const Found found = find_object(layers, object);
  const Layer& layer = *found.layer;
  if (layer.hash != "MurmurHash3_32" || layer.conversion != "uint32_to_float32")
    throw Error(
        ErrorCode::data,
        cat("the Cryptomatte \"", layer.name, "\" hashes by \"", layer.hash, "\" and \"", layer.conversion, "\""),
        "known is MurmurHash3_32 with uint32_to_float32");
  CryptomatteObject out{cryptomatte_id(found.name), ranks_of(ViewChannels(file.info(), view), layer.name)};
  if (out.ranks.empty())
    throw Error(ErrorCode::no_input,
                cat("the Cryptomatte \"", layer.name, "\" has no channels ", layer.name, "00.R, ", layer.name, "00.G"));
  return out;
}

Plane cryptomatte_coverage(const ExrReader& file, const CryptomatteObject& object, Window window) {
  Plane sum(window.width(), window.height());
  for (const CryptomatteObject::Rank& rank : object.ranks) {
    Plane id(window.width(), window.height()), coverage(window.width(), window.height());
    const ExrReader::Request of_id[] = {{rank.id.channel, id}}, of_coverage[] = {{rank.coverage.channel, coverage}};
    file.read(rank.id.part, of_id, window);
    file.read(rank.coverage.part, of_coverage, window);
    for (int y = 0; y < sum.height(); ++y)
      for (int x = 0; x < sum.width(); ++x)
        if (std::bit_cast<uint32_t>(id(x, y)) == std::bit_cast<uint32_t>(object.id)) sum(x, y) += coverage(x, y);
  }
  return sum;
}

}  // namespace aftershade::io
