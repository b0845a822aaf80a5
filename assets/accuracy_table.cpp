#include "assets/accuracy_table.h"

#include <algorithm>

#include "assets/muscle_table.h"

namespace mobil {
namespace {

// Written by: mobil effects --measure
constexpr AccuracyRow measured_rows[] = {
    // clang-format off
    {Muscle{0}, SpeedClass::slow, false, {0.032F, 0.00384F, 0.00192F, 0.00112F, 0.0008F, 0.000576F, 0.00048F, 0.000384F, 0.000352F, 0.000192F, 0.00448F}},
    {Muscle{0}, SpeedClass::free, false, {0.04F, 0.0048F, 0.0024F, 0.0014F, 0.001F, 0.00072F, 0.0006F, 0.00048F, 0.00044F, 0.00024F, 0.0056F}},
    {Muscle{0}, SpeedClass::fast, false, {0.05F, 0.006F, 0.003F, 0.00175F, 0.00125F, 0.0009F, 0.00075F, 0.0006F, 0.00055F, 0.0003F, 0.007F}},
    {Muscle{0}, SpeedClass::slow, true, {0.032F, 0.00538F, 0.00269F, 0.00157F, 0.00112F, 0.000806F, 0.000672F, 0.000538F, 0.000493F, 0.000269F, 0.00627F}},
    {Muscle{0}, SpeedClass::free, true, {0.04F, 0.00672F, 0.00336F, 0.00196F, 0.0014F, 0.00101F, 0.00084F, 0.000672F, 0.000616F, 0.000336F, 0.00784F}},
    {Muscle{0}, SpeedClass::fast, true, {0.05F, 0.0084F, 0.0042F, 0.00245F, 0.00175F, 0.00126F, 0.00105F, 0.00084F, 0.00077F, 0.00042F, 0.0098F}},
    {Muscle{1}, SpeedClass::slow, false, {0.028F, 0.0056F, 0.00168F, 0.00098F, 0.0007F, 0.000504F, 0.00042F, 0.000336F, 0.000308F, 0.000168F, 0.00392F}},
    {Muscle{1}, SpeedClass::free, false, {0.035F, 0.007F, 0.0021F, 0.00123F, 0.000875F, 0.00063F, 0.000525F, 0.00042F, 0.000385F, 0.00021F, 0.0049F}},
    {Muscle{1}, SpeedClass::fast, false, {0.0438F, 0.00875F, 0.00263F, 0.00153F, 0.00109F, 0.000788F, 0.000656F, 0.000525F, 0.000481F, 0.000263F, 0.00613F}},
    {Muscle{1}, SpeedClass::slow, true, {0.028F, 0.00784F, 0.00235F, 0.00137F, 0.00098F, 0.000706F, 0.000588F, 0.00047F, 0.000431F, 0.000235F, 0.00549F}},
    {Muscle{1}, SpeedClass::free, true, {0.035F, 0.0098F, 0.00294F, 0.00172F, 0.00122F, 0.000882F, 0.000735F, 0.000588F, 0.000539F, 0.000294F, 0.00686F}},
    {Muscle{1}, SpeedClass::fast, true, {0.0438F, 0.0123F, 0.00367F, 0.00214F, 0.00153F, 0.0011F, 0.000919F, 0.000735F, 0.000674F, 0.000367F, 0.00858F}},
    {Muscle{2}, SpeedClass::slow, false, {0.028F, 0.0126F, 0.00168F, 0.00098F, 0.0007F, 0.000504F, 0.00042F, 0.000336F, 0.000308F, 0.000168F, 0.00392F}},
    {Muscle{2}, SpeedClass::free, false, {0.035F, 0.0158F, 0.0021F, 0.00123F, 0.000875F, 0.00063F, 0.000525F, 0.00042F, 0.000385F, 0.00021F, 0.0049F}},
    {Muscle{2}, SpeedClass::fast, false, {0.0438F, 0.0197F, 0.00263F, 0.00153F, 0.00109F, 0.000788F, 0.000656F, 0.000525F, 0.000481F, 0.000263F, 0.00613F}},
    {Muscle{2}, SpeedClass::slow, true, {0.028F, 0.0176F, 0.00235F, 0.00137F, 0.00098F, 0.000706F, 0.000588F, 0.00047F, 0.000431F, 0.000235F, 0.00549F}},
    {Muscle{2}, SpeedClass::free, true, {0.035F, 0.022F, 0.00294F, 0.00172F, 0.00122F, 0.000882F, 0.000735F, 0.000588F, 0.000539F, 0.000294F, 0.00686F}},
    {Muscle{2}, SpeedClass::fast, true, {0.0438F, 0.0276F, 0.00367F, 0.00214F, 0.00153F, 0.0011F, 0.000919F, 0.000735F, 0.000674F, 0.000367F, 0.00858F}},
    {Muscle{3}, SpeedClass::slow, false, {0.016F, 0.00128F, 0.00096F, 0.00056F, 0.0004F, 0.000288F, 0.00024F, 0.000192F, 0.000176F, 9.6e-05F, 0.00224F}},
    {Muscle{3}, SpeedClass::free, false, {0.02F, 0.0016F, 0.0012F, 0.0007F, 0.0005F, 0.00036F, 0.0003F, 0.00024F, 0.00022F, 0.00012F, 0.0028F}},
    {Muscle{3}, SpeedClass::fast, false, {0.025F, 0.002F, 0.0015F, 0.000875F, 0.000625F, 0.00045F, 0.000375F, 0.0003F, 0.000275F, 0.00015F, 0.0035F}},
    {Muscle{3}, SpeedClass::slow, true, {0.016F, 0.00179F, 0.00134F, 0.000784F, 0.00056F, 0.000403F, 0.000336F, 0.000269F, 0.000246F, 0.000134F, 0.00314F}},
    {Muscle{3}, SpeedClass::free, true, {0.02F, 0.00224F, 0.00168F, 0.00098F, 0.0007F, 0.000504F, 0.00042F, 0.000336F, 0.000308F, 0.000168F, 0.00392F}},
    {Muscle{3}, SpeedClass::fast, true, {0.025F, 0.0028F, 0.0021F, 0.00123F, 0.000875F, 0.00063F, 0.000525F, 0.00042F, 0.000385F, 0.00021F, 0.0049F}},
    // clang-format on
};

constexpr std::array<RungCost, 2> measured_cost = {{
    RungCost{{0.0F, 0.0F, 0.00567F, 0.0085F, 0.0113F, 0.017F, 0.0227F, 0.034F, 0.0453F, 0.0453F, 1.5F},
             {0.0F, 0.05F, 0.0192F, 0.0269F, 0.0346F, 0.05F, 0.0654F, 0.0962F, 0.127F, 0.127F, 0.0F}},
    RungCost{{0.0F, 0.0F, 0.0167F, 0.025F, 0.0333F, 0.05F, 0.0667F, 0.1F, 0.133F, 0.133F, 1.5F},
             {0.0F, 0.05F, 0.0192F, 0.0269F, 0.0346F, 0.05F, 0.0654F, 0.0962F, 0.127F, 0.127F, 0.0F}},
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
