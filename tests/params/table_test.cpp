#include "core/params/table.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/base/error.h"

namespace aftershade::params {
namespace {

enum class Colour { red, dark_blue };

struct Sample {
  float radius_m = 0.05F;
  int taps = 4;
  bool on = true;
  Colour colour = Colour::dark_blue;
  std::string text = "a";
  bool operator==(const Sample&) const = default;

  static const Table& table() {
    static const Table records = TableBuilder<Sample>()
                                     .add("radius_m", &Sample::radius_m, {0.001, 1000}, "Reach.")
                                     .add("taps", &Sample::taps, {1, 64}, "How many.")
                                     .add("on", &Sample::on, "Whether.")
                                     .add("colour", &Sample::colour, {"red", "dark-blue"}, "Which.")
                                     .add("text", &Sample::text, "What.")
                                     .build();
    return records;
  }
};

const Record& record(std::string_view key) { return find(Sample::table(), key, "here"); }

template <class Work>
std::string error_of(Work&& work) {
  try {
    work();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::config);
    return error.what();
  }
  return "no error";
}
std::string read_error(const char* json) {
  Sample sample;
  return error_of([&] { read(Sample::table(), &sample, Json::parse(json), "f.json: stage s"); });
}
std::string value_error(std::string_view key, std::string_view text) {
  return error_of([&] { parse_value(record(key), text, "--set"); });
}

TEST(Table, DefaultsAreTheMemberInitialisers) {
  EXPECT_EQ(record("radius_m").default_value.dump(), "0.05");
  EXPECT_EQ(record("taps").default_value, 4);
  EXPECT_EQ(record("on").default_value, true);
  EXPECT_EQ(record("colour").default_value, "dark-blue");
  EXPECT_EQ(record("text").default_value, "a");
}

TEST(Table, WritesInOrderAndReadsBack) {
  const Sample sample{1.25F, 7, false, Colour::red, "b"};
  const Json json = write(Sample::table(), &sample);
  EXPECT_EQ(json.dump(), R"({"radius_m":1.25,"taps":7,"on":false,"colour":"red","text":"b"})");
  Sample copy;
  read(Sample::table(), &copy, json, "x");
  EXPECT_EQ(copy, sample);
}

TEST(Table, ReadChangesTheGivenKeysOnly) {
  Sample sample{1.25F, 7, false, Colour::red, "b"};
  read(Sample::table(), &sample, Json{{"taps", 9}}, "x");
  EXPECT_EQ(sample, (Sample{1.25F, 9, false, Colour::red, "b"}));
}

TEST(Table, RangesAreInclusive) {
  Sample sample;
  read(Sample::table(), &sample, Json{{"radius_m", 0.001}, {"taps", 64}}, "x");
  read(Sample::table(), &sample, Json{{"radius_m", 1000}, {"taps", 1}}, "x");
  EXPECT_EQ(sample.radius_m, 1000);
  EXPECT_EQ(sample.taps, 1);
}

TEST(Table, MessagesNameFileStageKeyAndRange) {
  EXPECT_EQ(read_error(R"({"radius_m": -1})"),
            "f.json: stage s: radius_m: -1 is out of range 0.001 to 1000 m (Reach.)");
  EXPECT_EQ(read_error(R"({"taps": 65})"), "f.json: stage s: taps: 65 is out of range 1 to 64 (How many.)");
  EXPECT_EQ(read_error(R"({"taps": 1e300})"), "f.json: stage s: taps: 1e+300 is out of range 1 to 64 (How many.)");
  EXPECT_EQ(read_error(R"({"taps": 2.5})"), "f.json: stage s: taps: 2.5 is not a whole number (How many.)");
  EXPECT_EQ(read_error(R"({"radius_m": "2"})"), "f.json: stage s: radius_m: \"2\" is not a number (Reach.)");
  EXPECT_EQ(read_error(R"({"on": 1})"), "f.json: stage s: on: 1 is not true or false (Whether.)");
  EXPECT_EQ(read_error(R"({"text": null})"), "f.json: stage s: text: null is not a text in quotes (What.)");
  EXPECT_EQ(read_error(R"({"colour": "blue"})"), "f.json: stage s: colour: \"blue\" is not one of red, dark-blue");
  EXPECT_EQ(read_error(R"({"colour": "Red"})"),
            "f.json: stage s: colour: \"Red\" is not one of red, dark-blue (did you mean \"red\"?)");
  EXPECT_EQ(read_error(R"({"radus_m": 1})"), "f.json: stage s: unknown key \"radus_m\" (did you mean \"radius_m\"?)");
  EXPECT_EQ(read_error(R"({"zzz": 1})"),
            "f.json: stage s: unknown key \"zzz\" (known keys: radius_m, taps, on, colour, text)");
}

TEST(Table, WholeNumbersMayHaveAPoint) {  // as JSON Schema's "integer"
  Sample sample;
  read(Sample::table(), &sample, Json::parse(R"({"taps": 5.0})"), "x");
  EXPECT_EQ(sample.taps, 5);
}

TEST(ParseValue, TakesTextAsTheRecordsKind) {
  EXPECT_EQ(parse_value(record("radius_m"), "1.5", "x"), 1.5);
  EXPECT_EQ(parse_value(record("radius_m"), "2", "x"), 2);
  EXPECT_EQ(parse_value(record("taps"), "+5", "x"), 5);
  EXPECT_EQ(parse_value(record("on"), "false", "x"), false);
  EXPECT_EQ(parse_value(record("colour"), "red", "x"), "red");
  EXPECT_EQ(parse_value(record("text"), "1.5", "x"), "1.5");
}

TEST(ParseValue, RefusesTheRest) {
  EXPECT_EQ(value_error("radius_m", "wide"), "--set: radius_m: \"wide\" is not a number (Reach.)");
  EXPECT_EQ(value_error("radius_m", "1,5"), "--set: radius_m: \"1,5\" is not a number (Reach.)");
  EXPECT_EQ(value_error("radius_m", ""), "--set: radius_m: \"\" is not a number (Reach.)");
  EXPECT_EQ(value_error("radius_m", "nan"), "--set: radius_m: \"nan\" is not a number (Reach.)");
  EXPECT_EQ(value_error("radius_m", "inf"), "--set: radius_m: \"inf\" is not a number (Reach.)");
  EXPECT_EQ(value_error("radius_m", "0"), "--set: radius_m: 0 is out of range 0.001 to 1000 m (Reach.)");
  EXPECT_EQ(value_error("taps", "2.5"), "--set: taps: 2.5 is not a whole number (How many.)");
  EXPECT_EQ(value_error("on", "yes"), "--set: on: \"yes\" is not true or false (Whether.)");
}

TEST(JsonOf, IsTheShortestDecimal) {
  EXPECT_EQ(json_of(0.1F).dump(), "0.1");
  EXPECT_EQ(json_of(1.0F / 3).dump(), "0.33333334");
  for (const float value : {0.05F, 1e-7F, 3.4e38F, 16777217.0F, -0.3F, 1.0F / 3})
    EXPECT_EQ(json_of(value).get<float>(), value);
}

TEST(Unit, ComesFromTheKey) {
  const auto unit_of = [](const char* key, Kind kind = Kind::number) {
    return unit(Record{key, kind, {0, 1}, {}, "", {}, {}, {}});
  };
  EXPECT_EQ(unit_of("radius_m"), "m");
  EXPECT_EQ(unit_of("max_radius_px"), "px");
  EXPECT_EQ(unit_of("bias_deg"), "deg");
  EXPECT_EQ(unit_of("dilation_texels", Kind::integer), "texels");
  EXPECT_EQ(unit_of("shutter_frames"), "frames");
  EXPECT_EQ(unit_of("scale"), "");
  EXPECT_EQ(unit_of("stem"), "");
  EXPECT_EQ(unit_of("shown_in_px", Kind::boolean), "");
}

TEST(DomainText, SaysWhatIsAllowed) {
  EXPECT_EQ(domain_text(record("radius_m")), "0.001 to 1000 m");
  EXPECT_EQ(domain_text(record("taps")), "1 to 64");
  EXPECT_EQ(domain_text(record("on")), "true or false");
  EXPECT_EQ(domain_text(record("colour")), "one of red, dark-blue");
  EXPECT_EQ(domain_text(record("text")), "any text");
}

TEST(SchemaProperties, DescribeEveryRecord) {
  const Json schema = schema_properties(Sample::table());
  EXPECT_EQ(schema.size(), Sample::table().size());
  EXPECT_EQ(schema["radius_m"].dump(),
            R"({"type":"number","minimum":0.001,"maximum":1000.0,"default":0.05,"description":"Reach."})");
  EXPECT_EQ(schema["taps"].dump(),
            R"({"type":"integer","minimum":1,"maximum":64,"default":4,"description":"How many."})");
  EXPECT_EQ(schema["on"].dump(), R"({"type":"boolean","default":true,"description":"Whether."})");
  EXPECT_EQ(schema["colour"].dump(), R"({"enum":["red","dark-blue"],"default":"dark-blue","description":"Which."})");
  EXPECT_EQ(schema["text"].dump(), R"({"type":"string","default":"a","description":"What."})");
}

}  // namespace
}  // namespace aftershade::params
