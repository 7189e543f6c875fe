// Nacre: tests of files that appear only when they are whole.
#include "engine/system/output_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <fstream>
#include <string>
#include <vector>

#include "compute/device/error.hpp"
#include "tests/engine/io/temporary_folder.hpp"

namespace nacre {
namespace {

using test::read_all;
using test::TemporaryFolder;

template <class Action>
std::string error_of(const Action& action) {
  try {
    action();
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

/// Lets this process write files of at most `bytes`, without the signal that would end it.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  void (*handler_)(int);
  rlimit before_{};
};

TEST(OutputFile, AppearsOnCommitOnly) {
  const TemporaryFolder folder;
  OutputFile file(folder / "a.txt");
  file.write("one ");
  file.write("two");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.txt"));
  EXPECT_EQ(file.temporary().parent_path(), folder.path());
  EXPECT_EQ(file.temporary().extension(), ".txt");
  file.commit();
  EXPECT_EQ(read_all(folder / "a.txt"), "one two");
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(OutputFile, WithoutCommitTheOlderFileStays) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.txt") << "old";
  {
    OutputFile file(folder / "a.txt");
    file.write("new");
  }
  EXPECT_EQ(read_all(folder / "a.txt"), "old");
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(OutputFile, KeepsPermissionsAndFollowsLinks) {
  const TemporaryFolder folder;
  std::ofstream(folder / "real.txt") << "old";
  ::chmod((folder / "real.txt").c_str(), 0640);
  std::filesystem::create_symlink("real.txt", folder / "link.txt");
  OutputFile file(folder / "link.txt");
  file.write("new");
  file.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.txt"));
  EXPECT_EQ(read_all(folder / "real.txt"), "new");
  EXPECT_EQ(std::filesystem::status(folder / "real.txt").permissions(), std::filesystem::perms(0640));
}

TEST(OutputFile, FollowsALinkToAFileThatIsNotThereYet) {
  const TemporaryFolder folder;
  std::filesystem::create_symlink("real.txt", folder / "link.txt");
  OutputFile file(folder / "link.txt");
  file.write("new");
  file.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.txt"));
  EXPECT_EQ(read_all(folder / "real.txt"), "new");
}

TEST(OutputFile, DevicesCanBeRefused) {
  EXPECT_NE(error_of([] { OutputFile("/dev/null", OutputFile::Devices::refused); }).find("not a regular file"),
            std::string::npos);
  EXPECT_EQ(error_of([] { OutputFile("/dev/null").commit(); }), "");
}

TEST(OutputFile, BadPlacesAreNamed) {
  const TemporaryFolder folder;
  const std::string missing = error_of([&] { OutputFile(folder / "no/such/a.txt"); });
  EXPECT_NE(missing.find("no/such/a.txt (No such file or directory)"), std::string::npos) << missing;
  EXPECT_NE(error_of([&] { OutputFile(folder.path()); }).find("Is a directory"), std::string::npos);
  std::ofstream(folder / "file") << "x";
  EXPECT_NE(error_of([&] { OutputFile(folder / "file/a.txt"); }).find("Not a directory"), std::string::npos);
  EXPECT_NE(error_of([&] { OutputFile(""); }), "");
  const std::string long_name = error_of([&] { OutputFile(folder / std::string(300, 'a')); });
  EXPECT_NE(long_name.find("choose a shorter name"), std::string::npos) << long_name;
  if (::geteuid() != 0) {
    ::chmod(folder.path().c_str(), 0555);
    EXPECT_NE(error_of([&] { OutputFile(folder / "a.txt"); }).find("Permission denied"), std::string::npos);
    ::chmod(folder.path().c_str(), 0755);
  }
}

TEST(OutputFile, FullDiskIsAnErrorAtWriteOrCommit) {
  const std::string text(100, 'x');  // stays in the buffer until commit
  const std::string late = error_of([&] {
    OutputFile file("/dev/full");
    file.write(text);
    file.commit();
  });
  EXPECT_NE(late.find("/dev/full (No space left on device)"), std::string::npos) << late;
  const std::vector<char> large(1 << 20);
  EXPECT_NE(error_of([&] { OutputFile("/dev/full").write(large.data(), large.size()); }).find("No space left"),
            std::string::npos);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

TEST(OutputFile, FileSizeLimitLeavesNothingBehind) {
  const TemporaryFolder folder;
  const std::vector<char> large(200000, 'x');
  const FileSizeLimit limit(65536);
  const std::string message = error_of([&] {
    OutputFile file(folder / "a.bin");
    for (int i = 0; i < 10; ++i) file.write(large.data(), large.size());
    file.commit();
  });
  EXPECT_NE(message.find("a.bin (File too large)"), std::string::npos) << message;
  EXPECT_EQ(folder.entries(), 0u);
}

TEST(OutputFile, WhatCannotBeWrittenIsFoundBefore) {
  const TemporaryFolder folder;
  check_writable(folder / "a.txt");
  EXPECT_EQ(folder.entries(), 0u);
  { std::ofstream(folder / "old.txt") << "old"; }
  check_writable(folder / "old.txt");
  EXPECT_EQ(read_all(folder / "old.txt"), "old");
  check_writable("/dev/stdout");
  EXPECT_NE(error_of([&] { check_writable(folder / "none/a.txt"); }).find("create the folder first"),
            std::string::npos);
  EXPECT_NE(error_of([&] { check_writable(folder.path()); }).find("give the name of a file"), std::string::npos);
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(OutputFile, UnfinishedFilesCanBeRemoved) {
  const TemporaryFolder folder;
  OutputFile kept(folder / "kept.txt");
  kept.commit();
  OutputFile lost(folder / "lost.txt");
  std::filesystem::create_directories(folder / "scratch/deep");
  add_unfinished(folder / "scratch");
  remove_unfinished_files();
  EXPECT_EQ(folder.entries(), 1u);
  EXPECT_TRUE(std::filesystem::exists(folder / "kept.txt"));
}

/// Files of somebody else that have the names that would be taken next are neither used nor removed.
TEST(OutputFile, TakenNamesArePassedOver) {
  const TemporaryFolder folder;
  std::string name;
  {
    const OutputFile probe(folder / "probe.txt");
    name = std::filesystem::directory_iterator(folder.path())->path().filename().string();
  }
  const std::size_t number_at = name.rfind('-') + 1;
  const int number = std::stoi(name.substr(number_at));
  for (int k = 1; k <= 3; ++k)
    std::ofstream(folder / (name.substr(0, number_at) + std::to_string(number + k) + ".txt")) << "foreign";
  OutputFile lost(folder / "lost.txt");
  EXPECT_EQ(folder.entries(), 4u);
  remove_unfinished_files();
  EXPECT_EQ(folder.entries(), 3u);
  for (int k = 1; k <= 3; ++k)
    EXPECT_EQ(read_all(folder / (name.substr(0, number_at) + std::to_string(number + k) + ".txt")), "foreign");
}

TEST(OutputFileDeathTest, LeavingRemovesWhatOthersAreWriting) {
  const TemporaryFolder folder;
  EXPECT_EXIT(
      {
        OutputFile whole(folder / "whole.txt");
        OutputFile lost(folder / "lost.txt");
        whole.commit();
        leave_without_unfinished_files(7);
      },
      ::testing::ExitedWithCode(7), "");
  EXPECT_EQ(folder.entries(), 1u);
}

}  // namespace
}  // namespace nacre
