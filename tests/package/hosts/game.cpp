// The same by breve.hpp.
#include <breve/breve.hpp>
#include <cstdio>

int main() {
  const char* agents = "@use Control.\nController Game.\nControl : Game { + to iterate: super iterate. }\n";
  auto runtime = breve::Runtime::create().or_throw();
  auto program = runtime.compile("game.tz", agents).or_throw();
  auto world = runtime.world(program).or_throw();
  if (!world.step()) return 1;
  std::puts("stepped");
}
