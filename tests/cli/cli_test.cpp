// Every folder of tests/cli/cases is a case: `run` is a shell script, `expect` says what must come of it, a line each:
//   status N | stdout TEXT | stderr TEXT | no-stdout TEXT | no-stderr TEXT | empty stdout|stderr | file PATH | no-file
//   PATH
// A case runs in an empty folder with $AFTERSHADE the program, $FIXTURE the sequences of
// fixture/make_cli_fixture.cpp, and $COMPARE the program of fixture/compare_channels.cpp.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace {

namespace fs = std::filesystem;
const fs::path kCases = fs::path(AFTERSHADE_SOURCE_DIR) / "tests/cli/cases";
const fs::path kBinary = AFTERSHADE_BINARY_DIR;

std::string read(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<std::string> case_names() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(kCases)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

struct Outcome {
  int status;
  std::string out, err;
};

Outcome run_case(const std::string& name, const fs::path& folder) {
  fs::remove_all(folder);
  fs::create_directories(folder);
  const std::string command = "cd '" + folder.string() + "' && AFTERSHADE='" + (kBinary / "bin/aftershade").string() +
                              "' COMPARE='" + (kBinary / "bin/compare_channels").string() + "' FIXTURE='" +
                              (kBinary / "cli-fixture").string() + "' NO_COLOR=1 sh '" +
                              (kCases / name / "run").string() + "' > '" + folder.string() + ".out' 2> '" +
                              folder.string() + ".err'";
  const int result = std::system(command.c_str());
  return {WIFEXITED(result) ? WEXITSTATUS(result) : -1, read(folder.string() + ".out"), read(folder.string() + ".err")};
}

class Cli : public testing::TestWithParam<std::string> {};

TEST_P(Cli, DoesWhatItShould) {
  const fs::path folder = kBinary / "cli-work" / GetParam();
  const Outcome outcome = run_case(GetParam(), folder);
  const std::string shown = "\nstdout:\n" + outcome.out + "\nstderr:\n" + outcome.err;
  std::istringstream expect(read(kCases / GetParam() / "expect"));
  int checks = 0;
  for (std::string line; std::getline(expect, line);) {
    if (line.empty()) continue;
    ++checks;
    const std::string what = line.substr(0, line.find(' ')), text = line.substr(line.find(' ') + 1);
    const auto has = [&](const std::string& where) { return where.find(text) != std::string::npos; };
    if (what == "status")
      EXPECT_EQ(outcome.status, std::stoi(text)) << shown;
    else if (what == "stdout" || what == "no-stdout")
      EXPECT_EQ(has(outcome.out), what == "stdout") << line << shown;
    else if (what == "stderr" || what == "no-stderr")
      EXPECT_EQ(has(outcome.err), what == "stderr") << line << shown;
    else if (what == "empty")
      EXPECT_TRUE((text == "stdout" ? outcome.out : outcome.err).empty()) << line << shown;
    else if (what == "file" || what == "no-file")
      EXPECT_EQ(fs::exists(folder / text), what == "file") << line << shown;
    else
      ADD_FAILURE() << "unknown expectation: " << line;
  }
  EXPECT_GE(checks, 2) << "a case states its status and at least one more thing";
}

INSTANTIATE_TEST_SUITE_P(Cases, Cli, testing::ValuesIn(case_names()), [](const auto& param) {
  std::string name = param.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
