#include "systems/relevance/accuracy_table.h"

#include <algorithm>

#include "assets/muscles/muscle_table.h"

namespace mobil {
namespace {

// Written by: mobil effects --measure
constexpr AccuracyRow measured_rows[] = {
    // clang-format off
    {Muscle{0}, SpeedClass::slow, false, {0.0286F, 0.00513F, 0.000527F, 0.00025F, 0.000249F, 0.00022F, 0.00021F, 0.000209F, 0.000222F, 0.00018F, 0.00127F}},
    {Muscle{0}, SpeedClass::free, false, {0.0336F, 0.007F, 0.000768F, 0.000402F, 0.000378F, 0.000347F, 0.000296F, 0.000309F, 0.00035F, 0.000251F, 0.00151F}},
    {Muscle{0}, SpeedClass::fast, false, {0.0379F, 0.00827F, 0.000932F, 0.000428F, 0.000427F, 0.000371F, 0.000409F, 0.000453F, 0.000448F, 0.00028F, 0.00192F}},
    {Muscle{1}, SpeedClass::slow, false, {0.0464F, 0.00541F, 0.00101F, 0.000888F, 0.000834F, 0.000779F, 0.000684F, 0.000631F, 0.000586F, 0.000162F, 0.00298F}},
    {Muscle{1}, SpeedClass::free, false, {0.0484F, 0.00609F, 0.00134F, 0.0011F, 0.00102F, 0.000964F, 0.000873F, 0.000768F, 0.00071F, 0.000256F, 0.00341F}},
    {Muscle{1}, SpeedClass::fast, false, {0.0507F, 0.0111F, 0.00154F, 0.00125F, 0.0012F, 0.00117F, 0.0012F, 0.00111F, 0.00101F, 0.00056F, 0.00354F}},
    {Muscle{2}, SpeedClass::slow, false, {0.0343F, 0.0121F, 0.00155F, 0.00155F, 0.00134F, 0.00125F, 0.00108F, 0.00101F, 0.00103F, 0.000702F, 0.00376F}},
    {Muscle{2}, SpeedClass::free, false, {0.0317F, 0.0163F, 0.00264F, 0.00246F, 0.00211F, 0.00202F, 0.00166F, 0.00155F, 0.00152F, 0.00111F, 0.00514F}},
    {Muscle{2}, SpeedClass::fast, false, {0.0302F, 0.0182F, 0.00369F, 0.00333F, 0.00281F, 0.00266F, 0.00219F, 0.00215F, 0.00214F, 0.00147F, 0.0067F}},
    {Muscle{3}, SpeedClass::slow, false, {0.0225F, 0.0149F, 0.00221F, 0.000737F, 0.000553F, 0.000399F, 0.000354F, 0.000414F, 0.000339F, 0.000259F, 0.00246F}},
    {Muscle{3}, SpeedClass::free, false, {0.0209F, 0.0154F, 0.00341F, 0.00122F, 0.000752F, 0.000604F, 0.000499F, 0.000516F, 0.00049F, 0.000388F, 0.00298F}},
    {Muscle{3}, SpeedClass::fast, false, {0.0182F, 0.0155F, 0.00489F, 0.00181F, 0.0012F, 0.000908F, 0.000661F, 0.000728F, 0.000584F, 0.000505F, 0.0036F}},
    {Muscle{0}, SpeedClass::slow, true, {0.0314F, 0.00653F, 0.00125F, 0.000947F, 0.000733F, 0.00047F, 0.000454F, 0.000425F, 0.000388F, 0.000179F, 0.00248F}},
    {Muscle{0}, SpeedClass::free, true, {0.0363F, 0.0099F, 0.00205F, 0.00178F, 0.00141F, 0.000881F, 0.000733F, 0.000598F, 0.000569F, 0.00038F, 0.00279F}},
    {Muscle{0}, SpeedClass::fast, true, {0.0434F, 0.0216F, 0.00362F, 0.00346F, 0.00314F, 0.00246F, 0.00242F, 0.00142F, 0.00116F, 0.000725F, 0.00395F}},
    {Muscle{1}, SpeedClass::slow, true, {0.0489F, 0.00873F, 0.00234F, 0.00157F, 0.00133F, 0.0012F, 0.00108F, 0.00105F, 0.000826F, 0.000184F, 0.0055F}},
    {Muscle{1}, SpeedClass::free, true, {0.0525F, 0.0121F, 0.00325F, 0.00212F, 0.00171F, 0.00146F, 0.00121F, 0.00118F, 0.000992F, 0.000378F, 0.00603F}},
    {Muscle{1}, SpeedClass::fast, true, {0.0782F, 0.0312F, 0.00736F, 0.00407F, 0.0046F, 0.00331F, 0.0023F, 0.00189F, 0.00159F, 0.00159F, 0.00925F}},
    {Muscle{2}, SpeedClass::slow, true, {0.0343F, 0.0259F, 0.00354F, 0.0022F, 0.00223F, 0.00144F, 0.00132F, 0.00122F, 0.00128F, 0.0013F, 0.00459F}},
    {Muscle{2}, SpeedClass::free, true, {0.0317F, 0.0317F, 0.00544F, 0.00349F, 0.00384F, 0.00238F, 0.00204F, 0.00193F, 0.00197F, 0.00193F, 0.00663F}},
    {Muscle{2}, SpeedClass::fast, true, {0.053F, 0.0422F, 0.00877F, 0.0051F, 0.00503F, 0.00407F, 0.00334F, 0.00258F, 0.00278F, 0.00273F, 0.00845F}},
    {Muscle{3}, SpeedClass::slow, true, {0.0277F, 0.0148F, 0.00629F, 0.00201F, 0.00206F, 0.00154F, 0.000618F, 0.000465F, 0.000403F, 0.000381F, 0.00285F}},
    {Muscle{3}, SpeedClass::free, true, {0.0328F, 0.0271F, 0.0109F, 0.0042F, 0.00397F, 0.00286F, 0.00131F, 0.000845F, 0.000803F, 0.000575F, 0.00482F}},
    {Muscle{3}, SpeedClass::fast, true, {0.0571F, 0.0443F, 0.00966F, 0.00577F, 0.00573F, 0.00489F, 0.00353F, 0.00282F, 0.00227F, 0.000866F, 0.00938F}},
    // clang-format on
};

constexpr std::array<RungCost, 2> measured_cost = {{
    RungCost{{0.0F, 0.0F, 0.00309F, 0.00394F, 0.00455F, 0.00659F, 0.00687F, 0.011F, 0.0136F, 0.0136F, 1.56F},
             {0.0F, 0.102F, 0.0711F, 0.0795F, 0.114F, 0.147F, 0.146F, 0.237F, 0.404F, 0.404F, 0.0F}},
    RungCost{{0.0F, 0.0F, 0.0153F, 0.0177F, 0.02F, 0.0231F, 0.0268F, 0.0348F, 0.0415F, 0.0415F, 1.65F},
             {0.0F, 0.182F, 0.0905F, 0.104F, 0.118F, 0.165F, 0.241F, 0.458F, 0.988F, 0.988F, 0.0F}},
}};

constexpr AccuracyTable measured{measured_rows, measured_cost};

}  // namespace

const AccuracyTable& accuracy_table() {
  return measured;
}

const AccuracyRow* AccuracyTable::find(Muscle muscle, SpeedClass speed, bool inertia) const {
  const auto row_of = [&](Muscle whose) {
    const auto at = std::ranges::find_if(rows, [&](const AccuracyRow& row) {
      return row.muscle == whose && row.speed == speed && row.inertia == inertia;
    });
    return at == rows.end() ? nullptr : &*at;
  };
  const AccuracyRow* own = row_of(muscle);
  return own != nullptr ? own : row_of(members_of(muscle).front().group);
}

}  // namespace mobil
