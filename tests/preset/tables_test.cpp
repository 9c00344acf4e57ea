#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>

#include "core/base/error.h"
#include "core/preset/preset.h"

/// Properties of every record of every method's table.
namespace aftershade::preset {
namespace {

using params::Json;
using params::Kind;
using params::Record;

/// Calls `check` with every record of every method; a failure names the two.
void for_each_record(const std::function<void(const Record&, const std::string& method)>& check) {
  for (const MethodInfo& info : methods())
    for (const Record& record : *info.table) {
      SCOPED_TRACE(std::string(info.method) + "." + record.key);
      check(record, std::string(info.method));
    }
}

bool is_number(const Record& record) { return record.kind == Kind::number || record.kind == Kind::integer; }

/// A bound of the record's range as the JSON type that the record takes.
Json bound(const Record& record, double value) {
  return record.kind == Kind::integer ? Json(std::lround(value)) : Json(value);
}

/// The message with which check() refuses `value`; "" if it does not.
std::string refusal(const Record& record, const Json& value) {
  try {
    params::check(record, value, "my.json: stage x");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::config);
    return error.what();
  }
  return "";
}

TEST(EveryRecord, DefaultIsAllowed) {
  for_each_record(
      [&](const Record& record, const std::string&) { EXPECT_EQ(refusal(record, record.default_value), ""); });
}

TEST(EveryRecord, OutOfRangeIsRefusedWithKeyAndRange) {
  for_each_record([&](const Record& record, const std::string&) {
    if (!is_number(record)) return;
    ASSERT_LT(record.range.min, record.range.max);
    EXPECT_EQ(refusal(record, bound(record, record.range.min)), "");
    EXPECT_EQ(refusal(record, bound(record, record.range.max)), "");
    for (const Json& value :
         {Json(std::floor(record.range.min) - 1), Json(std::ceil(record.range.max) + 1), Json(-1e30), Json(1e30)}) {
      const std::string message = refusal(record, value);
      EXPECT_NE(message.find("my.json: stage x: " + record.key + ": "), std::string::npos) << message;
      EXPECT_NE(message.find("out of range " + params::domain_text(record)), std::string::npos) << message;
    }
  });
}

TEST(EveryRecord, WrongTypeIsRefused) {
  for_each_record([&](const Record& record, const std::string&) {
    const Json text("no such value"), number(1.5), flag(true), list = Json::array(), object = Json::object(), null;
    for (const Json& value : {text, number, flag, list, object, null}) {
      const bool fits = (value.is_number() && record.kind == Kind::number) ||
                        (value.is_boolean() && record.kind == Kind::boolean) ||
                        (value.is_string() && record.kind == Kind::text);
      if (!fits) {
        EXPECT_NE(refusal(record, value).find(record.key), std::string::npos) << value.dump();
      }
    }
  });
}

TEST(EveryRecord, HasOneSentenceOfDocumentation) {
  for_each_record([&](const Record& record, const std::string&) {
    EXPECT_GE(record.doc.size(), 20U);
    EXPECT_TRUE(record.doc.ends_with('.')) << record.doc;
    EXPECT_TRUE(std::isupper(static_cast<unsigned char>(record.doc.front()))) << record.doc;
    EXPECT_EQ(record.doc.find('\n'), std::string::npos);
  });
}

TEST(EveryRecord, KeyIsSpelledAsKeysAre) {
  for_each_record([&](const Record& record, const std::string&) {
    for (const char c : record.key)
      EXPECT_TRUE(std::islower(static_cast<unsigned char>(c)) || std::isdigit(static_cast<unsigned char>(c)) ||
                  c == '_')
          << c;
    for (const std::string_view wrong : {"_meters", "_metres", "_pixels", "_degrees", "_percent", "_cm", "_mm"})
      EXPECT_FALSE(record.key.ends_with(wrong)) << "lengths are in _m or _px, angles in _deg";
  });
}

TEST(EveryRecord, KeyOfALengthCarriesItsUnit) {
  for_each_record([&](const Record& record, const std::string&) {
    if (!is_number(record)) return;
    for (const std::string_view word : {"radius", "distance", "extent", "height", "width", "angle", "length"})
      if (record.key.find(word) != std::string::npos) {
        EXPECT_NE(params::unit(record), "") << record.key;
      }
  });
}

TEST(EveryRecord, SchemaSaysTheSame) {
  const Json json = schema();
  for_each_record([&](const Record& record, const std::string& method) {
    const Json& entry = json["definitions"][method]["properties"][record.key];
    EXPECT_EQ(entry["default"], record.default_value);
    EXPECT_EQ(entry["description"], record.doc);
    if (is_number(record)) {
      EXPECT_EQ(entry["minimum"].get<double>(), record.range.min);
      EXPECT_EQ(entry["maximum"].get<double>(), record.range.max);
    }
  });
}

/// A value that differs from the default, so that what is written can be told from what was there.
Json other_value(const Record& record) {
  switch (record.kind) {
    case Kind::number:
      return record.default_value.get<double>() == record.range.max ? record.range.min : record.range.max;
    case Kind::integer:
      return std::lround(record.default_value.get<double>() == record.range.max ? record.range.min : record.range.max);
    case Kind::boolean:
      return !record.default_value.get<bool>();
    case Kind::choice:
      return record.default_value == record.choices.back() ? record.choices.front() : record.choices.back();
    case Kind::text:
      return "another text";
  }
  return nullptr;
}

TEST(EveryMethod, EveryKeyReachesItsOwnMember) {
  for_each_method([]<class Params>(std::type_identity<Params>) {
    for (const Record& record : Params::table()) {
      Params changed;
      params::read(Params::table(), &changed, Json{{record.key, other_value(record)}}, "x");
      EXPECT_NE(changed, Params{}) << Params::method << "." << record.key;
      const Json written = params::write(Params::table(), &changed);
      const Params defaults;
      const Json untouched = params::write(Params::table(), &defaults);
      for (const Record& other : Params::table())
        EXPECT_EQ(written[other.key] != untouched[other.key], other.key == record.key)
            << record.key << " changes " << other.key;
    }
  });
}

TEST(EveryMethod, TheTableHoldsEveryMember) {
  for_each_method([]<class Params>(std::type_identity<Params>) {
    Params all;
    for (const Record& record : Params::table()) record.put(&all, other_value(record));
    Params copy;
    params::read(Params::table(), &copy, params::write(Params::table(), &all), "x");
    EXPECT_EQ(copy, all) << Params::method;
  });
}

TEST(EveryMethod, KeysAreUniqueAndNotReserved) {
  for (const MethodInfo& info : methods()) {
    std::set<std::string> keys{"id", "method", "before", "after", "remove"};
    for (const Record& record : *info.table)
      EXPECT_TRUE(keys.insert(record.key).second) << info.method << "." << record.key;
  }
}

}  // namespace
}  // namespace aftershade::preset
