#include <fmt/format.h>

#include <mobil/assets/files/output_file.h>
#include <mobil/png.h>
#include "demo/lab/paper/paper.h"
#include "demo/program/progress.h"

namespace mobil {

void PaperRun::progress(std::string_view what, double part) const {
  show_part(fmt::format("{}: {}", entry, what), part);
}

Result<void> PaperRun::wrote(const Result<void>& done, const std::string& file) {
  if (done) written.push_back(file);
  return done;
}

Result<void> PaperRun::write(const PlotFigure& figure) {
  return wrote(write_file(out / (entry + ".svg"), svg(figure)), entry + ".svg");
}

Result<void> PaperRun::write_csv(const std::string& csv_text) {
  return wrote(write_file(out / (entry + ".csv"), csv_text), entry + ".csv");
}

Result<void> PaperRun::write_picture(std::string_view caption, const std::function<Result<Image>()>& make) {
  if (blind_) return {};
  progress("pictures", 0.9);
  const auto image = make();
  if (!image) {
    blind_ = true;
    text += fmt::format("No pictures: {}\n", image.error().message);
    return {};
  }
  text += fmt::format("{}{}\n", text.empty() ? "" : "\n", caption);
  return wrote(write_png((out / (entry + ".png")).string(), *image, PngEffort::small), entry + ".png");
}

BodyRequest paper_body() {
  BodyRequest body;
  body.height_m = paper_height_m;
  body.mass_kg = paper_mass_kg;
  return body;
}

GaitRequest paper_gait() {
  GaitRequest gait;
  gait.speed_m_s = paper_speed_m_s;
  return gait;
}

LegMuscles only(std::initializer_list<Muscle> muscles) {
  LegMuscles choice;
  choice.muscles.reset();
  for (const Muscle muscle : muscles) choice.muscles.set(static_cast<std::size_t>(muscle));
  return choice;
}

}  // namespace mobil
