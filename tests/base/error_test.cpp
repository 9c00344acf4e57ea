#include "core/base/error.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "core/base/units.h"

namespace aftershade {
namespace {

TEST(Error, TextIsMessageAndHint) {
  EXPECT_STREQ(Error(ErrorCode::data, "message").what(), "message");
  EXPECT_STREQ(Error(ErrorCode::data, "message", "hint").what(), "message (hint)");
}

TEST(Error, ContextComesInFront) {
  Error error(ErrorCode::io, "disk full", "make room");
  error.add_context("beauty.1042.exr");
  error.add_context("while writing frame 1042");
  EXPECT_STREQ(error.what(), "while writing frame 1042: beauty.1042.exr: disk full (make room)");
  EXPECT_EQ(error.message(), "while writing frame 1042: beauty.1042.exr: disk full");
  EXPECT_EQ(error.hint(), "make room");
  EXPECT_EQ(error.code(), ErrorCode::io);
}

TEST(WithContext, PassesResultsAndAddsToErrors) {
  EXPECT_EQ(with_context("x", [] { return 3; }), 3);
  try {
    with_context("x", [] { throw Error(ErrorCode::usage, "m"); });
    FAIL() << "the error was swallowed";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "x: m");
    EXPECT_EQ(error.code(), ErrorCode::usage);
  }
  EXPECT_THROW(with_context("x", [] { throw std::runtime_error("y"); }), std::runtime_error);
}

TEST(ExitStatus, IsThatOfSysexits) {
  EXPECT_EQ(exit_status(ErrorCode::usage), 64);
  EXPECT_EQ(exit_status(ErrorCode::data), 65);
  EXPECT_EQ(exit_status(ErrorCode::no_input), 66);
  EXPECT_EQ(exit_status(ErrorCode::internal), 70);
  EXPECT_EQ(exit_status(ErrorCode::cannot_create), 73);
  EXPECT_EQ(exit_status(ErrorCode::io), 74);
  EXPECT_EQ(exit_status(ErrorCode::config), 78);
  EXPECT_EQ(exit_status(ErrorCode::memory), 33);
}

TEST(Units, AreMetres) {
  EXPECT_EQ(metres_per_unit("m"), 1);
  EXPECT_EQ(metres_per_unit("cm"), 0.01);
  EXPECT_EQ(metres_per_unit("mm"), 0.001);
  EXPECT_EQ(metres_per_unit("ft"), 0.3048);
  EXPECT_EQ(metres_per_unit("0.0254"), 0.0254);
}

TEST(Units, RefuseTheRest) {
  for (const char* unit : {"", "M", "inch", "0", "-1", "nan", "inf", "1 m"}) {
    try {
      metres_per_unit(unit);
      ADD_FAILURE() << unit << " is taken";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::usage);
      EXPECT_NE(error.message().find(std::string("\"") + unit + "\""), std::string::npos);
      EXPECT_FALSE(error.hint().empty());
    }
  }
}

}  // namespace
}  // namespace aftershade
