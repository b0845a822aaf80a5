// mobil_rivals [--quick] [NAME…]: one JSON object a line for each requested measurement, all by default.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "demo/lab/rivals/rival.h"

#ifdef __SSE__
#include <xmmintrin.h>
#endif

namespace {

void print(const rivals::Rival& rival) {
  const auto best = std::min_element(rival.variants.begin(), rival.variants.end(),
                                     [](const auto& a, const auto& b) { return a.best_us < b.best_us; });
  std::printf(
      "{\"name\": \"%s\", \"us_per_step\": %.6g, \"median_us_per_step\": %.6g, \"dt_s\": %.6g, "
      "\"us_per_simulated_s\": %.6g, \"repeats\": %d, \"variant\": \"%s\", \"check\": \"%s\", "
      "\"check_error\": %.3g, \"holds\": %s, \"far_z_m\": %.9g, \"variants\": {",
      rival.name.c_str(), best->best_us, best->median_us, rival.dt_s, best->best_us / rival.dt_s, rival.repeats,
      best->name.c_str(), rival.check.c_str(), rival.check_error, rival.holds ? "true" : "false", rival.far_z_m);
  for (auto v = rival.variants.begin(); v != rival.variants.end(); ++v) {
    std::printf("%s\"%s\": %.6g", v == rival.variants.begin() ? "" : ", ", v->name.c_str(), v->best_us);
  }
  std::printf("}}\n");
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
#ifdef __SSE__
  _mm_setcsr(_mm_getcsr() | 0x8040);  // denormal numbers are zero, as in mobil
#endif
  std::vector<std::string> names(argv + 1, argv + argc);
  const bool quick = !names.empty() && names.front() == "--quick";
  if (quick) names.erase(names.begin());
  const double limit_s = quick ? 0 : 0.12;
  if (names.empty()) {
    names = {"eigen", "eigen_individual", "eigen_batched"};
    if (rivals::has_bullet()) names.emplace_back("bullet");
  }
  for (const std::string& name : names) {
    char* end = nullptr;
    const double dt = name.starts_with("bullet@") ? std::strtod(name.c_str() + std::strlen("bullet@"), &end) : 0;
    const bool is_bullet = name == "bullet" || (end != nullptr && *end == '\0' && dt >= 1e-5 && dt <= 0.1);
    if (name == "eigen") {
      print(rivals::eigen(limit_s));
    } else if (name == "eigen_individual") {
      print(rivals::eigen_individual(limit_s));
    } else if (name == "eigen_batched") {
      print(rivals::eigen_batched(limit_s));
    } else if (is_bullet && rivals::has_bullet()) {
      print(rivals::bullet(dt, limit_s));
    } else {
      std::fprintf(stderr,
                   is_bullet ? "mobil_rivals: '%s': built without Bullet; install libbullet-dev and configure again\n"
                             : "mobil_rivals: there is no measurement '%s'; there are: eigen, eigen_individual, "
                               "eigen_batched, bullet, "
                               "bullet@SECONDS (a step of 1e-5 to 0.1 s)\n",
                   name.c_str());
      return 2;
    }
  }
  return 0;
}
