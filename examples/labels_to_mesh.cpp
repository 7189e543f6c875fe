// Nacre: a volume of labels becomes triangles and tetrahedra. Usage: labels_to_mesh OUT.vtp OUT.vtu
#include <cstdio>
#include <nacre/mesh.hpp>

int main(int argc, char** argv) try {
  if (argc != 3) return std::fputs("usage: labels_to_mesh OUT.vtp OUT.vtu\n", stderr), 2;
  std::vector<std::uint8_t> labels(32 * 32 * 32);  // a ball (1) around a smaller one (2)
  for (int i = 0; i < 32 * 32 * 32; ++i) {
    const double x = i % 32 - 15.5, y = i / 32 % 32 - 15.5, z = i / 1024 - 15.5, r = x * x + y * y + z * z;
    labels[i] = r < 36 ? 2 : r < 144 ? 1 : 0;
  }
  nacre::VolumeView volume = nacre::volume_view<std::uint8_t>(labels, {32, 32, 32}, {0.7, 0.7, 0.7});
  volume.names = {{1, "shell"}, {2, "core"}};
  nacre::Meshing run(volume, {{"max_size", 1.5}});
  nacre::save(argv[1], run.mesh());
  nacre::save(argv[2], run.mesh(), run.tetrahedra());
  std::printf("%zu triangles, %zu tetrahedra, %s\n", run.mesh().triangles.size(), run.tetrahedra().cells.size(),
              run.quality().sound ? "sound" : "not sound");
} catch (const nacre::Error& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 1;
}
