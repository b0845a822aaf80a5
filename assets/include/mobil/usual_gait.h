#pragma once
// Manner, speed and step length of people by sex and age.

#include <cstdint>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>

namespace mobil::inline v0_3 {

/// Returns the usual style of a person of that sex and age. Spawning does not apply it: pass it in GaitRequest::style,
/// with a person's own differences added. `Simulation::gait_request` returns the style that was requested.
///
/// Values differ from GaitStyle{} in these parameters. Pelvic list is 3.5° (men) or 4.25° (women), and 4.0° up to 10
/// years (Smith et al., Am. J. Phys. Med. Rehabil. 81, 2002). Women turn the pelvis by 7.15° and swing their arms 1.05
/// times as far (direction: Bruening et al., Gait & Posture, 2015; size assumed). Differences of sex begin at 10 years
/// and are complete at 14. From 60 years on, every 15 years take 25 % of the pelvis' turn (Cury et al. 2021) and 20 %
/// of the arm swing (Mirelman et al. 2015), and add 1° of trunk lean (assumed). Beyond 84 years the style stays. Old
/// people's weaker push-off (Judge et al. 1996) follows from their shorter steps.
GaitStyle usual_style(const BodyRequest& body);

/// Returns the usual walking speed on level ground of that sex and age, m/s. Adults: norms of GAITRite and of Hollman
/// et al. (Gait & Posture 34, 2011); children: barefoot, Pinzone et al. (2014). It is for the usual legs of that age.
float usual_speed_m_s(const BodyRequest& body);

/// Footwear of a walker whose step length is left out.
enum class Footwear : std::uint8_t { shoes, barefoot };

/// Step length in shoes of people of 18 to 66 years, over that of the step table for their legs (assets/gait).
inline constexpr double shod_step_factor = 1.056;

/// Returns the factor on the step table's usual length at that age. Barefoot it is 1 at every age. In shoes it is
/// `shod_step_factor` for adults, 1.11 times that at 6 years and 0.89 times at 87. Sources: children in shoes, Lythgo
/// et al. (Gait & Posture 33, 2011); adults as for `usual_speed_m_s`.
double usual_step_factor(float age_y, Footwear footwear = Footwear::shoes);

}  // namespace mobil::inline v0_3
