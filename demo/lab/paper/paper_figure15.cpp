// Figure 15: how long muscles are over the gait cycle, beside published lengths.

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include <mobil/anthropometry.h>
#include <mobil/muscle_table.h>
#include "demo/lab/compare/compare_judge.h"
#include "demo/lab/compare/compare_reference.h"
#include "demo/lab/paper/paper.h"
#include "demo/lab/paper/paper_cycle.h"
#include "demo/pictures/cycle_plot.h"

namespace mobil {
namespace {

/// What a published length is of, and the muscles of ours whose lengths' mean it is held against.
struct Compared {
  std::string_view published, title;
  std::array<std::string_view, 3> ours;
};
constexpr std::array compared = {
    Compared{"hamstrings", "hamstrings", {"semimembranosus", "semitendinosus", "biceps_femoris_long_head"}},
    Compared{"rectus_femoris", "rectus femoris", {"rectus_femoris"}},
    Compared{"gastrocnemius", "gastrocnemius", {"gastrocnemius_medial", "gastrocnemius_lateral"}},
    Compared{"soleus", "soleus", {"soleus"}},
    Compared{"tibialis_anterior", "tibialis anterior", {"tibialis_anterior"}}};

struct Walk {
  std::string published, title;
  PaperCycle ours;
  std::vector<PublishedLength> theirs;
};

Walk walk_at(double speed_m_s, std::string published, std::string title) {
  CycleRequest request{paper_body(), paper_gait(), only({}), {}, {}};
  request.muscles->cells = {2, 2, 2};  // only their lines are looked at
  request.gait.speed_m_s = static_cast<float>(speed_m_s);
  for (const Compared& what : compared) {
    for (const std::string_view name : what.ours) {
      if (const auto muscle = find_muscle(name)) request.muscles->muscles.set(static_cast<std::size_t>(*muscle));
    }
  }
  auto ours = walk_cycle(request);
  auto theirs = read_published_lengths(published);
  return Walk{std::move(published), fmt::format("{}, {:.2f} m/s", title, speed_m_s), std::move(ours),
              std::move(theirs)};
}

/// Mean of the muscles' lengths, each over its own in the anatomical position.
CycleCurve our_length(const PaperCycle& walk, const Compared& what) {
  CycleCurve sum{};
  double count = 0;
  for (const std::string_view name : what.ours) {
    const auto muscle = find_muscle(name);
    if (!muscle) continue;
    const MuscleCycle& own = walk.muscle(*muscle);
    for (std::size_t i = 0; i < cycle_points; ++i) sum[i] += own.length_m[i] / own.rest_length_m;
    ++count;
  }
  for (double& v : sum) v /= count;
  return sum;
}

struct Agreement {
  std::string published, walk, muscle;
  CycleCurve ours;
  const MeasuredCurve* theirs;
  bool has_band;

  double rms() const { return rms_distance(ours, theirs->mean); }
  double alike() const { return correlation(ours, theirs->mean); }
  double inside() const {
    const CurvePair pair{&ours, theirs};
    return inside_bands({&pair, 1});
  }
};

Agreement agreement(const Walk& walk, std::size_t muscle) {
  const MeasuredCurve& theirs = walk.theirs[muscle].curve;
  return {walk.published, walk.title,      std::string(compared[muscle].title), our_length(walk.ours, compared[muscle]),
          &theirs,        theirs.sd[0] > 0};
}

PlotPanel panel_of(const Agreement& pair) {
  PlotPanel panel = cycle_panel(fmt::format("{}: {}", pair.muscle, pair.walk), "length / anatomical");
  const std::string name = "gait2392 on measured angles";
  if (pair.has_band) {
    add_measured(panel, *pair.theirs, name, first_colour, false);
  } else {
    panel.lines.push_back({cycle_percents(), cycle_values(pair.theirs->mean), second_colour,
                           "gait2392 on OpenSim's normal gait", 1.4, true});
  }
  panel.lines.push_back({cycle_percents(), cycle_values(pair.ours), ours_colour, "mobil", 1.8, false});
  return panel;
}

PaperTable table_of(const std::vector<Agreement>& pairs) {
  PaperTable table{"muscle and walk",
                   {{"rms_percent", "rms\n%", 2},
                    {"correlation", "correlation", 3},
                    {"inside_band_percent", "inside\n± 1 SD, %", 0},
                    {"shortest_ours", "shortest\nours", 3},
                    {"shortest_published", "published", 3},
                    {"longest_ours", "longest\nours", 3},
                    {"longest_published", "published", 3}},
                   {}};
  for (const Agreement& pair : pairs) {
    const CycleRange ours = range_of(pair.ours), theirs = range_of(pair.theirs->mean);
    table.row.push_back({fmt::format("{}: {}", pair.muscle, pair.walk),
                         {100 * pair.rms(), pair.alike(), pair.has_band ? 100 * pair.inside() : NAN, ours.low,
                          theirs.low, ours.high, theirs.high}});
  }
  return table;
}

std::string csv_of(const std::vector<Agreement>& pairs) {
  std::string text = "muscle,curve,percent_gait,ours,published,published_sd\n";
  for (const Agreement& pair : pairs) {
    for (std::size_t i = 0; i < cycle_points; ++i) {
      text += fmt::format("{},{},{},{:.5f},{:.5f},{}\n", pair.muscle, pair.published, 2 * i, pair.ours[i],
                          pair.theirs->mean[i], pair.has_band ? fmt::format("{:.5f}", pair.theirs->sd[i]) : "");
    }
  }
  return text;
}

}  // namespace

void paper_figure15(PaperRun& run) {
  const auto reference = must(read_gait_reference({}));
  const auto body = must(make_body(paper_body()));
  const MeasuredSet& people = reference.sets.front();
  std::vector<Walk> walks;
  for (std::size_t c = compared_class::slow; c <= compared_class::fast; ++c) {
    run.progress("walking", static_cast<double>(c - compared_class::slow) / 4);
    const std::string name(compared_class_name[c]);
    walks.push_back(walk_at(people.speed_m_s(c, static_cast<double>(body.hip_height_m)), "schwartz_" + name, name));
  }
  walks.push_back(walk_at(static_cast<double>(paper_speed_m_s), "opensim_normal_gait", "OpenSim"));

  std::vector<Agreement> pairs;
  pairs.reserve(walks.size() * compared.size());
  for (const Walk& walk : walks) pairs.push_back(agreement(walk, 0));
  for (std::size_t speed = 0; speed + 1 < walks.size(); ++speed) {
    for (std::size_t m = 1; m < compared.size(); ++m) pairs.push_back(agreement(walks[speed], m));
  }

  PlotFigure figure{"Muscle lengths over the gait cycle, 1.80 m and 80 kg",
                    "Bands: gait2392 (Delp et al. 1990) on angles of Schwartz et al. 2008, their ± 1 SD carried over. "
                    "Hamstrings: mean of semimembranosus, semitendinosus and the long head of biceps femoris.",
                    4, 215, 150};
  for (const Agreement& pair : pairs) figure.panels.push_back(panel_of(pair));
  for (std::size_t i = 0; i < walks.size(); ++i) {  // one scale for all hamstrings
    figure.panels[i].y.low = 0.92;
    figure.panels[i].y.high = 1.14;
  }
  const auto worst = std::ranges::max_element(pairs.begin(), pairs.begin() + 3, {}, &Agreement::rms);
  const auto unlike = std::ranges::min_element(pairs, {}, &Agreement::alike);
  run.text = table_text(table_of(pairs)) +
             fmt::format(
                 "\nThe hamstrings' length at three speeds is within {:.1f} % rms of the published one, with "
                 "correlations of {:.3f}, {:.3f} and {:.3f},\nand {:.0f}, {:.0f} and {:.0f} % of the cycle inside its "
                 "band.\nLeast alike of all: {} ({}), with a correlation of {:.3f}.\n",
                 100 * worst->rms(), pairs[0].alike(), pairs[1].alike(), pairs[2].alike(), 100 * pairs[0].inside(),
                 100 * pairs[1].inside(), 100 * pairs[2].inside(), unlike->muscle, unlike->walk, unlike->alike());
  run.write_csv(csv_of(pairs));
  run.write(figure);
}

}  // namespace mobil
