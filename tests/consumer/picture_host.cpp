// A host that writes a picture and uses no other part of mobil. The library brings its own dependencies.
#include <mobil/png.h>

#include <cstdio>

int main(int, char** argv) {
  const mobil::Image grey{2, 2, std::vector<std::uint8_t>(16, 128)};
  const auto refused = mobil::write_png("no/such/folder.png", grey);
  const auto written = mobil::write_png(argv[1], grey);
  std::puts(refused ? "" : refused.error().message.c_str());
  return written && !refused ? 0 : 1;
}
