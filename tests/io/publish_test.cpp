#include "core/io/publish.h"

#include <grp.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

#include "core/base/error.h"
#include "tests/io/exr_files.h"

namespace aftershade::io {
namespace {
using tests::read_file;
using tests::TempFolder;

ErrorCode code_of_publish(const std::string& bytes, const std::string& path, std::string& text) {
  try {
    publish(bytes, path);
  } catch (const Error& error) {
    text = error.what();
    return error.code();
  }
  return ErrorCode::internal;
}

TEST(Publish, WritesTheBytesAndNothingElse) {
  const TempFolder folder;
  const std::string bytes(300000, 'x');
  publish(bytes, folder / "a.exr");
  EXPECT_EQ(read_file(folder / "a.exr"), bytes);
  EXPECT_EQ(folder.file_count(), 1U);
}

TEST(Publish, ReplacesAnOlderFile) {
  const TempFolder folder;
  publish(std::string("old"), folder / "a.exr");
  publish(std::string("new"), folder / "a.exr");
  EXPECT_EQ(read_file(folder / "a.exr"), "new");
  EXPECT_EQ(folder.file_count(), 1U);
}

TEST(Publish, NamesTheFolderThatIsMissing) {
  const TempFolder folder;
  std::string text;
  EXPECT_EQ(code_of_publish("x", folder / "none/a.exr", text), ErrorCode::cannot_create);
  EXPECT_NE(text.find(folder / "none"), std::string::npos) << text;
  EXPECT_NE(text.find("No such file"), std::string::npos) << text;
}

TEST(Publish, RefusesAParentThatIsAFile) {
  const TempFolder folder;
  tests::write_file(folder / "plain", "x");
  std::string text;
  EXPECT_EQ(code_of_publish("x", folder / "plain/a.exr", text), ErrorCode::cannot_create);
  EXPECT_NE(text.find("Not a directory"), std::string::npos) << text;
}

enum Outcome { kPublished = 10, kNotPermitted, kOther };

/// What publishing comes to in a child without root's powers: permissions do not bind root.
int publish_without_powers(const std::string& path) {
  const pid_t child = ::fork();
  if (child == 0) {
    constexpr uid_t kNobody = 65534;
    if (::geteuid() == 0 && (::setgroups(0, nullptr) != 0 || ::setgid(kNobody) != 0 || ::setuid(kNobody) != 0))
      ::_exit(1);
    try {
      publish(std::string("x"), path);
      ::_exit(kPublished);
    } catch (const Error& error) {
      const bool denied = std::string(error.what()).find("Permission denied") != std::string::npos;
      ::_exit(error.code() == ErrorCode::cannot_create && denied ? kNotPermitted : kOther);
    }
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(Publish, RefusesAReadOnlyFolder) {
  const TempFolder folder;
  ::chmod(folder.path().c_str(), 0777);
  ASSERT_EQ(publish_without_powers(folder / "allowed.exr"), kPublished);
  ::chmod(folder.path().c_str(), 0555);
  EXPECT_EQ(publish_without_powers(folder / "a.exr"), kNotPermitted);
  ::chmod(folder.path().c_str(), 0755);
  EXPECT_EQ(folder.file_count(), 1U);
}

TEST(Publish, RefusesWhatIsNoRegularFile) {
  const TempFolder folder, inner;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  ASSERT_EQ(::symlink("pipe", (folder / "link").c_str()), 0);
  for (const std::string& path : {folder / "pipe", folder / "link", inner.path()}) {
    std::string text;
    EXPECT_EQ(code_of_publish("x", path, text), ErrorCode::cannot_create);
    EXPECT_NE(text.find(path + ": it is not a regular file"), std::string::npos) << text;
  }
  EXPECT_EQ(folder.file_count(), 2U);
  EXPECT_EQ(inner.file_count(), 0U);
  EXPECT_TRUE(std::filesystem::is_fifo(folder / "pipe"));
}

/// The exit status of a child whose files may not grow beyond 100000 bytes.
int publish_on_full_disk(const std::string& path) {
  const pid_t child = ::fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{100000, 100000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    std::string text;
    const ErrorCode code = code_of_publish(std::string(150000, 'x'), path, text);
    ::_exit(code == ErrorCode::io && text.find("File too large") != std::string::npos ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(Publish, LeavesNothingWhenTheDiskIsFull) {
  const TempFolder folder;
  EXPECT_EQ(publish_on_full_disk(folder / "a.exr"), 0);
  EXPECT_EQ(folder.file_count(), 0U);
}

TEST(Publish, KeepsTheOldFileWhenTheDiskIsFull) {
  const TempFolder folder;
  publish(std::string("old"), folder / "a.exr");
  EXPECT_EQ(publish_on_full_disk(folder / "a.exr"), 0);
  EXPECT_EQ(read_file(folder / "a.exr"), "old");
  EXPECT_EQ(folder.file_count(), 1U);
}

// SIGXFSZ arrives while a temporary is open, with part of the bytes in it: the handler removes it, as for Ctrl-C.
TEST(Publish, ASignalHandlerRemovesTheTemporary) {
  const TempFolder folder;
  const pid_t child = ::fork();
  if (child == 0) {
    std::signal(SIGXFSZ, [](int) {
      remove_temporaries();
      ::_exit(7);
    });
    const rlimit limit{100000, 100000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    publish(std::string(150000, 'x'), folder / "a.exr");
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 7);
  EXPECT_EQ(folder.file_count(), 0U);
}

TEST(FileId, TellsFilesNotNames) {
  const TempFolder folder;
  tests::write_file(folder / "a", "x");
  tests::write_file(folder / "b", "x");
  ASSERT_EQ(::link((folder / "a").c_str(), (folder / "hard").c_str()), 0);
  ASSERT_EQ(::symlink((folder / "a").c_str(), (folder / "soft").c_str()), 0);
  const auto id = file_id(folder / "a");
  ASSERT_TRUE(id);
  EXPECT_EQ(file_id(folder / "hard"), id);
  EXPECT_EQ(file_id(folder / "soft"), id);
  EXPECT_NE(file_id(folder / "b"), id);
  EXPECT_FALSE(file_id(folder / "none"));
}

}  // namespace
}  // namespace aftershade::io
