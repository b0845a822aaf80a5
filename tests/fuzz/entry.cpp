// libFuzzer's entry point for the target that tests/fuzz/targets.cmake names.
#include FUZZ_HEADER

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
  mobil::fuzz::FUZZ({bytes, count});
  return 0;
}
