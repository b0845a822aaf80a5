#include "assets/body/growth.h"

#include <array>
#include <cmath>
#include <cstddef>

#include <mobil/anthropometry.h>
#include <mobil/body_composition.h>
#include "engine/exact_math.h"

namespace mobil::inline v0_3 {
namespace {

constexpr float first_age_y = 6, last_age_y = 20;
using GrowthTable = std::array<GrowthRow, 29>;

// Rows of half years from 6 to 20 years.
constexpr GrowthTable boys = {{
    {{1.1501, 1.1539, 0.043636}, {-3.1973, 15.382, 0.082709}},
    {{0.97135, 1.186, 0.044039}, {-3.3099, 15.424, 0.087023}},
    {{0.76975, 1.2177, 0.044376}, {-3.325, 15.505, 0.091727}},
    {{0.58906, 1.2487, 0.044707}, {-3.2764, 15.621, 0.096665}},
    {{0.46293, 1.2788, 0.045091}, {-3.1911, 15.769, 0.10167}},
    {{0.4066, 1.3076, 0.045574}, {-3.0883, 15.946, 0.10661}},
    {{0.41314, 1.3351, 0.046164}, {-2.9802, 16.149, 0.11134}},
    {{0.4568, 1.3612, 0.046838}, {-2.874, 16.376, 0.11576}},
    {{0.50261, 1.3862, 0.047551}, {-2.7737, 16.625, 0.11979}},
    {{0.51902, 1.4106, 0.048248}, {-2.6813, 16.892, 0.12338}},
    {{0.49182, 1.4352, 0.048888}, {-2.5972, 17.177, 0.1265}},
    {{0.43873, 1.4614, 0.049446}, {-2.5213, 17.476, 0.12911}},
    {{0.41885, 1.4905, 0.049913}, {-2.4528, 17.788, 0.13123}},
    {{0.51686, 1.5237, 0.050253}, {-2.3908, 18.111, 0.13287}},
    {{0.78681, 1.5609, 0.050342}, {-2.334, 18.444, 0.13406}},
    {{1.1956, 1.6002, 0.049981}, {-2.2813, 18.783, 0.13483}},
    {{1.6358, 1.6384, 0.049046}, {-2.2314, 19.129, 0.13523}},
    {{1.9929, 1.6721, 0.047637}, {-2.1834, 19.478, 0.13531}},
    {{2.1955, 1.6994, 0.046024}, {-2.1363, 19.828, 0.13513}},
    {{2.2289, 1.7201, 0.044483}, {-2.0895, 20.179, 0.13476}},
    {{2.1258, 1.7351, 0.043182}, {-2.0429, 20.529, 0.13424}},
    {{1.9441, 1.7456, 0.042179}, {-1.9969, 20.874, 0.13367}},
    {{1.7413, 1.7529, 0.041458}, {-1.9527, 21.214, 0.1331}},
    {{1.5572, 1.758, 0.040971}, {-1.912, 21.547, 0.13262}},
    {{1.4105, 1.7616, 0.040663}, {-1.8772, 21.869, 0.1323}},
    {{1.3044, 1.7642, 0.040485}, {-1.8511, 22.18, 0.13224}},
    {{1.2338, 1.766, 0.040396}, {-1.8359, 22.477, 0.13253}},
    {{1.1907, 1.7674, 0.040365}, {-1.8331, 22.757, 0.13326}},
    {{1.1686, 1.7684, 0.040368}, {-1.8411, 22.999, 0.13441}},
}};
constexpr GrowthTable girls = {{
    {{-0.21562, 1.1471, 0.04494}, {-3.2358, 15.211, 0.093356}},
    {{-0.23495, 1.1817, 0.045206}, {-3.0969, 15.306, 0.098946}},
    {{-0.21349, 1.2149, 0.045442}, {-2.9396, 15.441, 0.10483}},
    {{-0.15985, 1.2464, 0.045674}, {-2.7803, 15.61, 0.1108}},
    {{-0.085934, 1.2759, 0.045943}, {-2.6293, 15.809, 0.11668}},
    {{-0.0041193, 1.3034, 0.046304}, {-2.4918, 16.035, 0.12231}},
    {{0.077393, 1.3292, 0.046831}, {-2.3703, 16.284, 0.12759}},
    {{0.16213, 1.3543, 0.047595}, {-2.2658, 16.553, 0.13242}},
    {{0.27332, 1.3799, 0.048612}, {-2.1779, 16.838, 0.13672}},
    {{0.45064, 1.4079, 0.049725}, {-2.1061, 17.136, 0.14047}},
    {{0.71868, 1.4398, 0.050493}, {-2.0494, 17.443, 0.14363}},
    {{1.0368, 1.4754, 0.05028}, {-2.0068, 17.757, 0.14621}},
    {{1.2885, 1.5119, 0.048772}, {-1.9774, 18.075, 0.14822}},
    {{1.3606, 1.545, 0.046407}, {-1.9604, 18.394, 0.14968}},
    {{1.2561, 1.5715, 0.044037}, {-1.955, 18.71, 0.15064}},
    {{1.09, 1.5908, 0.042236}, {-1.9602, 19.022, 0.15115}},
    {{0.9642, 1.6039, 0.041094}, {-1.9754, 19.328, 0.15126}},
    {{0.90498, 1.6127, 0.040448}, {-1.9996, 19.623, 0.15104}},
    {{0.89502, 1.6186, 0.040104}, {-2.0319, 19.907, 0.15056}},
    {{0.91142, 1.6226, 0.039924}, {-2.071, 20.178, 0.1499}},
    {{0.93869, 1.6255, 0.039827}, {-2.1153, 20.433, 0.14915}},
    {{0.96857, 1.6276, 0.03977}, {-2.163, 20.67, 0.14841}},
    {{0.99722, 1.6291, 0.039735}, {-2.2117, 20.888, 0.14777}},
    {{1.0231, 1.6303, 0.039709}, {-2.2586, 21.086, 0.14735}},
    {{1.0458, 1.6312, 0.039689}, {-2.3005, 21.262, 0.14726}},
    {{1.0654, 1.632, 0.039672}, {-2.3337, 21.414, 0.14763}},
    {{1.082, 1.6325, 0.039658}, {-2.3546, 21.541, 0.14861}},
    {{1.0962, 1.633, 0.039647}, {-2.3593, 21.643, 0.15034}},
    {{1.1071, 1.6334, 0.039637}, {-2.347, 21.712, 0.15272}},
}};

/// Adults at 30 years: mean and deviation of stature, m; median of the body mass index, kg/m², and deviation of its
/// logarithm.
struct Adults {
  double height_m, height_deviation_m, mass_index, mass_index_deviation;
};
/// Statures and mass indices: ANSUR II and the US population, rounded.
constexpr Adults grown_men = {1.757, 0.069, 24.6, 0.145}, grown_women = {1.629, 0.064, 23.6, 0.160};

}  // namespace

double lms_value(const Lms& of, double deviations) {
  constexpr double least = 1e-3;  // a skewed measure has no value beyond some deviations
  return of.median * exact::pow(std::fmax(least, 1 + of.power * of.spread * deviations), 1 / of.power);
}

const GrowthRow& growth(Sex sex, float age_y) {
  const float age = std::fmin(last_age_y, std::fmax(first_age_y, age_y));
  return (sex == Sex::woman ? girls : boys)[static_cast<std::size_t>(2 * (half_years(age) - first_age_y))];
}

double lost_height_m(Sex sex, float age_y) {
  const double at_70_m = sex == Sex::woman ? 0.05 : 0.03, older = std::fmax(0, static_cast<double>(age_y) - 30) / 40;
  return at_70_m * older * older;
}

BodyRequest typical_body(Sex sex, float age_y, float height_z, float mass_index_z) {
  const auto age = static_cast<double>(age_y), of_height = static_cast<double>(height_z),
             of_index = static_cast<double>(mass_index_z);
  const Adults& adults = sex == Sex::woman ? grown_women : grown_men;
  const double gained = 0.0035 * (std::fmin(age, 65) - 30);
  double height = adults.height_m + adults.height_deviation_m * of_height - lost_height_m(sex, age_y);
  double mass_index = adults.mass_index * (1 + gained) * exact::exp(adults.mass_index_deviation * of_index);
  if (age < static_cast<double>(last_age_y)) {  // from 18 years on, charts and adults are mixed
    const double grown = std::fmax(0, (age - adult_age_y) / (static_cast<double>(last_age_y) - adult_age_y));
    const GrowthRow& row = growth(sex, age_y);
    height = grown * height + (1 - grown) * lms_value(row.height_m, of_height);
    mass_index = grown * mass_index + (1 - grown) * lms_value(row.mass_index, of_index);
  }
  BodyRequest request;
  request.height_m = static_cast<float>(height);
  request.mass_kg = static_cast<float>(mass_index * height * height);
  request.sex = sex;
  request.age_y = age_y;
  return request;
}

StatureRange living_height_m(Sex sex, float age_y) {
  if (static_cast<double>(half_years(age_y)) >= adult_age_y) return {1.2, 2.2};
  constexpr double most_deviations = 4.5;
  const Lms& height = growth(sex, age_y).height_m;
  // Rounded outward to centimetres, as messages print it.
  return {0.01 * std::floor(100 * lms_value(height, -most_deviations)),
          0.01 * std::ceil(100 * lms_value(height, most_deviations))};
}

}  // namespace mobil::inline v0_3
