// Nacre: the `nacre` of a package for all x86-64 processors: starts the program that is compiled for the highest level
// of the instruction set that this processor has. NACRE_LEVEL=x86-64-v2 in the environment chooses another.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

struct Level {
  const char* name;
  bool runs;  ///< on this processor
};

std::string folder_of_this_program() {
  char path[4096];
  const ssize_t length = readlink("/proc/self/exe", path, sizeof path);
  const std::string self(path, length > 0 ? std::size_t(length) : 0);
  return self.substr(0, self.rfind('/'));
}

}  // namespace

int main(int, char** arguments) {
  __builtin_cpu_init();
  const Level levels[] = {{"x86-64-v4", __builtin_cpu_supports("x86-64-v4") != 0},
                          {"x86-64-v3", __builtin_cpu_supports("x86-64-v3") != 0},
                          {"x86-64-v2", __builtin_cpu_supports("x86-64-v2") != 0}};
  const std::string programs = folder_of_this_program() + "/../libexec/nacre/";
  const char* wanted = std::getenv("NACRE_LEVEL");
  if (wanted && !*wanted) wanted = nullptr;
  for (const Level& level : levels) {
    if (!level.runs || (wanted && std::strcmp(wanted, level.name) != 0)) continue;
    const std::string program = programs + level.name + "/nacre";
    if (access(program.c_str(), X_OK) != 0) continue;
    execv(program.c_str(), arguments);
    std::perror(("nacre: cannot start " + program).c_str());
    return 1;
  }
  if (wanted)
    std::fprintf(stderr, "nacre: there is no program for NACRE_LEVEL=%s that runs on this processor\n", wanted);
  else
    std::fputs("nacre: this processor is older than x86-64-v2 (SSE4.2), or the package is incomplete\n", stderr);
  return 1;
}
