#include "core/io/cryptomatte.h"

#include <gtest/gtest.h>

#include <bit>
#include <filesystem>

#include "core/base/error.h"
#include "core/io/exr_writer.h"

namespace aftershade::io {
namespace {

TEST(Murmur3, IsThatOfItsAuthorsVectors) {
  EXPECT_EQ(murmur3(""), 0U);
  EXPECT_EQ(murmur3("hello"), 0x248bfa47U);
  EXPECT_EQ(murmur3("hello, world"), 0x149bbb7fU);
  EXPECT_EQ(murmur3("The quick brown fox jumps over the lazy dog"), 0x2e4ff723U);
}

TEST(CryptomatteId, IsTheHashAsAFloatThatIsANumber) {
  EXPECT_EQ(std::bit_cast<uint32_t>(cryptomatte_id("hello")), 0x248bfa47U);
  int turned = 0;
  for (int i = 0; i < 4000; ++i) {
    const std::string name = "object" + std::to_string(i);
    const float id = cryptomatte_id(name);
    const uint32_t bits = std::bit_cast<uint32_t>(id), exponent = bits >> 23 & 255;
    EXPECT_TRUE(exponent != 0 && exponent != 255) << name;
    EXPECT_TRUE(bits == murmur3(name) || (bits ^ murmur3(name)) == 1U << 23) << name;
    turned += bits != murmur3(name);
  }
  EXPECT_GT(turned, 5) << "2 of 256 exponents";
}

/// A file with Cryptomattes, each of one pair of ranks: pixel 0 is a chair, pixel 1 two thirds chair over a table,
/// pixel 2 a table with a chair in the second rank, pixel 3 nothing.
struct Matte {
  std::string name, manifest, hash = "MurmurHash3_32", suffixes = "RGBA";
};
std::string write(const std::vector<Matte>& mattes) {
  const std::string path = (std::filesystem::path(testing::TempDir()) /
                            (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".exr"))
                               .string();
  const float chair = cryptomatte_id("chair"), table = cryptomatte_id("table");
  const float pixels[4][4] = {{chair, 1, 0, 0}, {chair, 0.6F, table, 0.4F}, {table, 0.75F, chair, 0.25F}, {0, 0, 0, 0}};
  NewFile file;
  file.display_window = {0, 0, 5, 0};
  file.data_window = {1, 0, 4, 0};
  std::vector<Plane> planes;
  for (int c = 0; c < 4; ++c) {
    Plane& plane = planes.emplace_back(4, 1);
    for (int x = 0; x < 4; ++x) plane(x, 0) = pixels[x][c];
  }
  file.channels.push_back({"Z", PixelType::single, planes[0]});
  for (size_t m = 0; m < mattes.size(); ++m) {
    for (size_t c = 0; c < 4; ++c)
      file.channels.push_back({mattes[m].name + "00." + mattes[m].suffixes.substr(c, 1), PixelType::single, planes[c]});
    const std::string key = "cryptomatte/" + std::to_string(m) + "a1b2/";
    file.texts.emplace_back(key + "name", mattes[m].name);
    file.texts.emplace_back(key + "hash", mattes[m].hash);
    file.texts.emplace_back(key + "conversion", "uint32_to_float32");
    if (!mattes[m].manifest.empty()) file.texts.emplace_back(key + "manifest", mattes[m].manifest);
  }
  write_new_exr(file, path);
  return path;
}

const Matte kObjects{"CryptoObject", R"({"chair":"00000000","table":"00000000"})"};
const Matte kMaterials{"CryptoMaterial", R"({"wood":"00000000","table":"00000000"})"};

void expect_coverage(const std::vector<Matte>& mattes, const std::string& object, std::array<float, 6> expected) {
  const ExrReader file(write(mattes));
  const Plane coverage = cryptomatte_coverage(file, find_cryptomatte(file, "", object), file.info().display_window);
  for (int x = 0; x < 6; ++x) EXPECT_FLOAT_EQ(coverage(x, 0), expected[static_cast<size_t>(x)]) << object << " " << x;
}

TEST(Cryptomatte, AddsUpTheRanksOfAnObjectWhateverTheSuffixes) {
  for (const std::string suffixes : {"RGBA", "rgba"}) {
    Matte matte = kObjects;
    matte.suffixes = suffixes;
    expect_coverage({matte, kMaterials}, "chair", {0, 1, 0.6F, 0.25F, 0, 0});
    expect_coverage({matte}, "table", {0, 0, 0.4F, 0.75F, 0, 0});
  }
}

TEST(Cryptomatte, IsFoundByNameByLayerAndWithoutManifest) {
  expect_coverage({kMaterials, kObjects}, "CryptoObject/table", {0, 0, 0.4F, 0.75F, 0, 0});
  expect_coverage({{"matte", ""}}, "chair", {0, 1, 0.6F, 0.25F, 0, 0});
  expect_coverage({{"matte", ""}}, "stool", {0, 0, 0, 0, 0, 0});
}

void expect_error(const std::vector<Matte>& mattes, const std::string& object, ErrorCode code,
                  const std::string& text) {
  const ExrReader file(write(mattes));
  try {
    find_cryptomatte(file, "", object);
    ADD_FAILURE() << "expected: " << text;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
  }
}

TEST(Cryptomatte, SaysWhatIsWrong) {
  expect_error({}, "chair", ErrorCode::no_input, "has no Cryptomatte");
  expect_error({kObjects}, "chairs", ErrorCode::no_input, "did you mean \"chair\"?");
  expect_error({kObjects, kMaterials}, "zzzzzzzz", ErrorCode::no_input, "CryptoObject, CryptoMaterial");
  expect_error({kObjects, kMaterials}, "table", ErrorCode::usage, "write CryptoObject/table");
  expect_error({{"matte", "", "md5"}}, "chair", ErrorCode::data, "md5");
  expect_error({{"matte", "[1"}}, "chair", ErrorCode::data, "is no JSON object");
  expect_error({{"matte", "", "MurmurHash3_32", "XYUV"}}, "chair", ErrorCode::no_input, "matte00.R");
}

}  // namespace
}  // namespace aftershade::io
