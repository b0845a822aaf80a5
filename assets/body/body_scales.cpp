#include "assets/body/body_scales.h"

namespace mobil::inline v0_3 {

BodySize<float> make_size(const BodyRequest& request, float extra_fat) {
  const float height_m = request.height_m;
  return {height_m, request.mass_kg, extra_fat, height_m, height_m, height_m, height_m, height_m};
}

}  // namespace mobil::inline v0_3
