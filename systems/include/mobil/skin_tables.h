#pragma once
// Tables for skin over muscles that nobody simulates, made from muscles that are.
//
//   SkinTables tables;
//   request.table = *tables.of(body);   // each person, once; SkinRequest
//   skin_writer.write(simulation.world(), requests);

#include <map>
#include <memory>
#include <utility>

#include <mobil/components/body.h>
#include <mobil/engine/error.h>
#include <mobil/systems/surfaces/skin_table.h>

namespace mobil::inline v0_3 {

/// A table for a body, from its groups of muscles at rest in walks from 0.7 to 1.9 m/s and in poses anywhere within the
/// table's angles. Lifts are in m of that body: for skins of SkinShape it must be as tall as `skin_body`. A second.
/// Errors: as make_body; limbs of their own (BodyRequest::limbs); no memory.
Result<std::unique_ptr<SkinTable>> make_skin_table(const BodyRequest& body);

/// Tables that people of about one build share.
class SkinTables {
 public:
  /// For a body: made for its sex and a body mass index within 1.5 kg/m² of its own, between 13.5 and 64.5 kg/m²;
  /// limbs of their own are not followed. A second for the first of a build. Good as long as this lives. Errors: as
  /// make_body. Not for several threads at once.
  Result<const SkinTable*> of(const BodyRequest& body);

 private:
  std::map<std::pair<Sex, int>, std::unique_ptr<SkinTable>> table_;
};

}  // namespace mobil::inline v0_3
