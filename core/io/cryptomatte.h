#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/channel_names.h"
#include "core/io/exr_reader.h"

/// Objects by name (Cryptomatte specification 1.2.0: "Cryptomatte layers", "Hashing", "Manifests"): every pixel has
/// ranks of an object's identifier and its coverage, in channels LAYER00.RG, LAYER00.BA, LAYER01.RG, ...
namespace aftershade::io {

/// MurmurHash3_32 of seed 0.
uint32_t murmur3(std::string_view text);
/// The identifier of a name as it stands in the pixels: the hash's bits as a float, of which the exponents that are no
/// number (0 and 255) have their lowest bit turned over.
float cryptomatte_id(std::string_view name);

/// The pairs of identifier and coverage channels of the layer that has an object.
struct CryptomatteObject {
  struct Rank {
    ChannelRef id, coverage;
  };
  float id = 0;
  std::vector<Rank> ranks;
};

/// `object` is a name, or LAYER/NAME for a Cryptomatte layer of the header ("CryptoObject/chair"). Without a layer it
/// is the one whose manifest has the name; a file with one layer needs no manifest. Throws Error(no_input) when the
/// file has no Cryptomatte, no such name (with the nearest) or none of the layer's channels, Error(usage) when several
/// layers have it, Error(data) when the layer hashes otherwise or its manifest is no JSON.
CryptomatteObject find_cryptomatte(const ExrReader& file, const std::string& view, const std::string& object);

/// The object's share of every pixel of `window`, 0 to 1: coverages of the ranks that hold it, added up; 0 outside the
/// data window.
Plane cryptomatte_coverage(const ExrReader& file, const CryptomatteObject& object, Window window);

}  // namespace aftershade::io
