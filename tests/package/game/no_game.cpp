// A library that is no game.
extern "C" int answer() {
  return 42;
}
