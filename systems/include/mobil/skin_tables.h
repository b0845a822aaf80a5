#pragma once
// Makes tables for skin over muscles that are not simulated, from simulated muscles.
//
//   SkinTables tables;
//   request.table = *tables.of(body);   // SkinRequest, once for each person
//   skin_writer.write(simulation.world(), requests);

#include <map>
#include <memory>
#include <tuple>

#include <mobil/components/body.h>
#include <mobil/engine/error.h>
#include <mobil/systems/surfaces/skin_table.h>

namespace mobil::inline v0_3 {

/// Makes a table for a body from its muscle groups: at rest, in walks from 0.7 to 1.9 m/s, and in poses within the
/// table's angles. Lifts are in m of that body, so for SkinShape it must be that of `skin_build`. Takes one second.
/// Errors: those of make_body, individual limb lengths (BodyRequest::limbs), out of memory.
Result<std::unique_ptr<SkinTable>> make_skin_table(const BodyRequest& body);

/// Tables that people of similar build share. Not thread-safe.
class SkinTables {
 public:
  /// Returns a table for a body, made for its sex, a similar age and a body mass index within 1.5 kg/m² of its own,
  /// between 13.5 and 64.5 kg/m². Individual limb lengths are ignored. The first table of a build takes one second.
  /// Valid as long as this object. Errors: those of make_body.
  Result<const SkinTable*> of(const BodyRequest& body);

 private:
  std::map<std::tuple<Sex, int, int>, std::unique_ptr<SkinTable>> table_;  // by age and build
};

}  // namespace mobil::inline v0_3
