#include "tests/rules/source_text.h"

#include <gtest/gtest.h>

#include "tests/rules/rules.h"

namespace aftershade::tests {
namespace {

TEST(CodeOnly, BlanksCommentsStringsAndCharacters) {
  EXPECT_EQ(code_only("a // { b\nc"), "a       \nc");
  EXPECT_EQ(code_only("a /* { \n } */ b"), "a      \n      b");
  EXPECT_EQ(code_only(R"(f("{\"", '{', '\'') + 1'000'000)"), "f(     ,    ,     ) + 1'000'000");
  EXPECT_EQ(code_only("R\"x({)\" }\n)x\" + b"), "R        \n    + b");
  EXPECT_EQ(code_only("u8R\"({)\"; OR\"{\";"), "u8R     ; OR   ;");
  EXPECT_EQ(code_only("a // b \\\n { c\n}"), "a       \n    \n}");
}

/// "header:line+lines" of every function.
std::string found(std::string_view text) {
  std::string out;
  for (const Function& f : functions(text))
    out += (out.empty() ? "" : " | ") + f.header + ":" + std::to_string(f.line) + "+" + std::to_string(f.lines);
  return out;
}

TEST(Functions, PlainMemberAndTemplate) {
  EXPECT_EQ(found("int f() {\n return 1;\n}\n"), "int f():1+3");
  EXPECT_EQ(found("namespace a::b {\nvoid f(int x,\n  int y) {\n}\n}\n"), "void f(int x, int y):2+3");
  EXPECT_EQ(
      found("class A : public B {\n public:\n  int f() const { return 1; }\n  struct C {\n    void g() {}\n  };\n};\n"),
      "int f() const:3+1 | void g():5+1");
  EXPECT_EQ(found("template <class T, class U = A<T>>\n  requires(x<T>)\nvoid f(T t) {\n}\n"),
            "template <class T, class U = A<T>> requires(x<T>) void f(T t):1+4");
  EXPECT_EQ(found("template <class T>\nstruct A {\n  T f() { return {}; }\n};"), "T f():3+1");
}

TEST(Functions, BracesThatAreNot) {
  EXPECT_EQ(found("const int a[] = {\n1,\n2};\nenum class E { x, y };\nint b{3};\nextern \"C\" {\n}\n"), "");
  EXPECT_EQ(found("std::array<int, 2> t = f({1, 2});\nvoid g(A a = {}) {\n}\n"), "void g(A a = {}):2+2");
  EXPECT_EQ(found("#define X {\n#if 0 // {\nvoid f() {}\n"), "void f():3+1");
}

TEST(Functions, LambdasCountWithTheirFunction) {
  EXPECT_EQ(found("void f() {\n  g([&](int x) {\n    if (x) {\n    }\n  });\n}\nvoid h() {}\n"),
            "void f():1+6 | void h():7+1");
  EXPECT_EQ(found("const auto f = [](int x) {\n  return x;\n};\nconst auto t = [] {\n return 1;\n}();\n"),
            "const auto f = [](int x):1+3 | const auto t = []:4+3");
}

TEST(Functions, ConstructorsWithBracedMembers) {
  EXPECT_EQ(found("A::A(int x) : a_(x), b_(1) {\n  f();\n}\n"), "A::A(int x) : a_(x), b_(1):1+3");
  const auto list = functions("A::A() : a_{1}, b_{2} {\n  f();\n}\nvoid g() {\n}\n");
  ASSERT_FALSE(list.empty());
  EXPECT_EQ(list.back().header, "void g()");
  EXPECT_TRUE(std::any_of(list.begin(), list.end(), [](const Function& f) { return f.lines == 3; }));
}

TEST(Functions, SixtyOneLinesAreTooMany) {
  const auto function = [](int lines) {
    return "void f() {\n" + std::string(static_cast<size_t>(lines - 2), '\n') + "}\n";
  };
  EXPECT_TRUE(check_functions({"core/base/x.cpp", function(60)}).empty());
  const Violations violations = check_functions({"core/base/x.cpp", "int a;\n" + function(61)});
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_EQ(violations[0], "core/base/x.cpp:2: has 61 lines; 60 are the limit: void f()");
  EXPECT_FALSE(
      check_functions({"tests/x/x.cpp", "TEST(A, B) {\n  const auto f = [] {\n" + std::string(60, '\n') + "  };\n}\n"})
          .empty());
}

}  // namespace
}  // namespace aftershade::tests
