#pragma once
// The paper's figures and questions, as `mobil paper` makes them.

#include <functional>

#include "demo/lab/paper/paper_cycle.h"
#include "demo/lab/paper/paper_table.h"
#include "demo/pictures/svg_plot.h"
#include "demo/program/must.h"

namespace mobil {

/// Input and output of an entry of the paper.
class PaperRun {
 public:
  explicit PaperRun(std::optional<std::filesystem::path> anatomy_folder) : anatomy(std::move(anatomy_folder)) {}

  /// Reports progress of the entry, 0–1; `what` is shown on a terminal.
  void progress(std::string_view what, double part) const;

  /// Writes ENTRY.svg, ENTRY.csv.
  void write(const PlotFigure& figure);
  void write_csv(const std::string& text);
  /// Writes ENTRY.png and reports `caption`. Without a graphics device reports that once and continues. `make` returns
  /// the picture.
  void write_picture(std::string_view caption, const std::function<Image()>& make);

  std::string entry;          // the one that is being made
  std::filesystem::path out;  // where its files are written until it is done
  std::optional<std::filesystem::path> anatomy;
  std::string text;  // report after completion
  std::vector<std::string> written;

 private:
  bool blind_ = false;  // no graphics device found
};

inline constexpr double millimetres = 1000;      // in one metre
inline constexpr Cells paper_mesh = {4, 4, 20};  // 525 nodes

/// The person of the paper's experiments: 1.80 m, 80 kg, and his walking speed.
inline constexpr float paper_height_m = 1.80F, paper_mass_kg = 80, paper_speed_m_s = 5 / 3.6F;
BodyRequest paper_body();
GaitRequest paper_gait();
/// Returns a choice of these muscles only.
LegMuscles only(std::initializer_list<Muscle> muscles);

void paper_figure14(PaperRun& run);
void paper_figure15(PaperRun& run);
void paper_figure16(PaperRun& run);
void paper_figure17(PaperRun& run);
void paper_weight(PaperRun& run);
void paper_step_length(PaperRun& run);
void paper_quadriceps(PaperRun& run);
void paper_stature(PaperRun& run);
void paper_contraction(PaperRun& run);
void paper_anatomy(PaperRun& run);

}  // namespace mobil
