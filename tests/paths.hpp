// Nacre: where tests find the program, the sources, and the data that are not in the repository.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace nacre::test {

// Constants of one generated file (paths.cpp.in): as macros on the command line they would make every clone compile all
// tests again. Initialised before any object with a constructor.
extern const char* const program_path;   ///< the program `nacre` that was built
extern const char* const source_folder;  ///< root of the repository
extern const char* const shared_folder;  ///< `shared/data` beside the repository; need not be there

/// The path of a file of the repository, from its root.
inline std::string source_file(const std::string& name) { return std::string(source_folder) + "/" + name; }

/// A file or folder of the shared data.
inline std::filesystem::path shared_data(const std::string& name) {
  return std::filesystem::path(shared_folder) / name;
}

/// Why a test that needs this part of the shared data is skipped.
inline std::string no_shared_data(const std::string& name) {
  return "there is no " + shared_data(name).lexically_normal().string() +
         ": real surfaces and volumes of other authors, too large for the repository; the test checks Nacre on them";
}

}  // namespace nacre::test

/// Skips the test, aloud, where a file or folder of the shared data is absent.
#define NACRE_NEEDS_SHARED_DATA(name) \
  if (!std::filesystem::exists(nacre::test::shared_data(name))) GTEST_SKIP() << nacre::test::no_shared_data(name)
