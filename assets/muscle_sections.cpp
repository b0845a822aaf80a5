#include "assets/muscle_sections.h"

#include <array>

namespace mobil {
namespace {

constexpr LegSection semimembranosus[] = {{0.150F, -33, -32, 6, 3, 105},
                                          {0.175F, -36, -25.3F, 10.8F, 4.6F, 107},
                                          {0.259F, -38.7F, -23.7F, 14.1F, 6.9F, 86},
                                          {0.343F, -39.6F, -22.3F, 19.4F, 7.9F, 88},
                                          {0.427F, -38.2F, -21.1F, 23.9F, 9.7F, 91},
                                          {0.511F, -38.6F, -19.4F, 26, 12.4F, 97},
                                          {0.637F, -33.8F, -17.3F, 26.3F, 16.4F, 108},
                                          {0.763F, -25.9F, -18.6F, 26.8F, 15.6F, 119},
                                          {0.847F, -23.8F, -18.5F, 27, 16.4F, 118},
                                          {0.931F, -28, -16.8F, 22.2F, 14.8F, 127},
                                          {0.974F, -32.6F, -16.7F, 19.4F, 9.6F, 140},
                                          {1.016F, -35.1F, -18.6F, 16.3F, 4.4F, 142},
                                          {1.059F, -37.5F, -12.6F, 12, 3.3F, 156},
                                          {1.102F, -36.9F, -4.1F, 10.8F, 2.5F, 177},
                                          {1.145F, -33, -1, 7, 2, 0}};
constexpr LegSection semitendinosus[] = {{0.132F, -27, -43, 5, 3, 95},
                                         {0.157F, -30.6F, -38.2F, 8.5F, 3.9F, 95},
                                         {0.203F, -27.8F, -36, 10.9F, 7.3F, 93},
                                         {0.296F, -29.1F, -37.2F, 14.9F, 9.7F, 95},
                                         {0.390F, -29.5F, -39.5F, 15.8F, 11.4F, 103},
                                         {0.483F, -28.2F, -40.3F, 16.5F, 11.5F, 104},
                                         {0.576F, -25.6F, -40.3F, 16.1F, 10.1F, 101},
                                         {0.669F, -24.5F, -40.5F, 14.9F, 8.4F, 102},
                                         {0.762F, -25, -39.2F, 12.9F, 6.6F, 106},
                                         {0.855F, -28.2F, -37.4F, 9.4F, 4.5F, 102},
                                         {0.948F, -32.7F, -33.6F, 6, 3.3F, 105},
                                         {1.041F, -37.2F, -26.1F, 4.3F, 2.8F, 146},
                                         {1.134F, -33.1F, -12.9F, 5.6F, 2.5F, 173},
                                         {1.273F, -17.2F, 11.8F, 5.4F, 0.9F, 13}};
constexpr LegSection biceps_femoris_long_head[] = {{0.118F, -20, -46, 5, 3, 80},
                                                   {0.133F, -19.8F, -44.1F, 8.5F, 4.1F, 76},
                                                   {0.216F, -9.3F, -39.1F, 9.9F, 9.2F, 32},
                                                   {0.258F, -4.4F, -33.3F, 14.4F, 12.1F, 4},
                                                   {0.300F, -0.6F, -28.9F, 17.8F, 17, 29},
                                                   {0.386F, 3.8F, -25.8F, 24.2F, 19.9F, 52},
                                                   {0.472F, 7.4F, -26.7F, 27.9F, 20.9F, 47},
                                                   {0.559F, 9.7F, -27.9F, 26.6F, 21.4F, 53},
                                                   {0.645F, 14.1F, -27.9F, 25.4F, 19.6F, 60},
                                                   {0.732F, 16.7F, -27.1F, 22.5F, 16.5F, 70},
                                                   {0.861F, 23.4F, -22.4F, 18.2F, 10, 82},
                                                   {0.945F, 33, -20.2F, 12.7F, 5.7F, 67},
                                                   {1.028F, 45.6F, -16.1F, 10.1F, 2.6F, 31},
                                                   {1.163F, 45.1F, -8.5F, 6.5F, 1.9F, 11}};
constexpr LegSection biceps_femoris_short_head[] = {
    {0.411F, 20.8F, -0.1F, 2.1F, 0.7F, 110},  {0.471F, 21.6F, -2.1F, 5.4F, 3.2F, 122},
    {0.532F, 21, -2.6F, 7.7F, 5, 117},        {0.593F, 19.6F, -3.2F, 9.2F, 6.4F, 112},
    {0.654F, 18.7F, -3.3F, 10.1F, 7.5F, 113}, {0.715F, 18.9F, -4.1F, 11.2F, 9, 107},
    {0.775F, 20.6F, -4.9F, 12, 10.1F, 99},    {0.835F, 23.5F, -5.7F, 12.3F, 10.5F, 97},
    {0.896F, 27.2F, -6, 10.7F, 10.3F, 156},   {0.955F, 34.5F, -7.8F, 11.1F, 6.7F, 9},
    {1.014F, 40.5F, -11.8F, 10, 3.4F, 18},    {1.076F, 41.5F, -14.7F, 7, 3.6F, 20},
    {1.140F, 42.4F, -10.7F, 5.6F, 2.4F, 179}};
constexpr LegSection rectus_femoris[] = {{-0.097F, 22.5F, 17.3F, 10.8F, 4.5F, 16},
                                         {0.013F, 29, 21.9F, 14, 9.6F, 103},
                                         {0.123F, 29.4F, 28, 23.4F, 13.5F, 92},
                                         {0.178F, 30.2F, 32.5F, 27.6F, 14.6F, 92},
                                         {0.288F, 33.1F, 44.7F, 30.8F, 14.5F, 96},
                                         {0.399F, 35.3F, 57.4F, 29.4F, 13.5F, 100},
                                         {0.508F, 32, 64.5F, 26, 11.6F, 94},
                                         {0.617F, 27, 66, 20.3F, 9.4F, 94},
                                         {0.726F, 22.3F, 63.8F, 15.6F, 7, 89},
                                         {0.834F, 16.5F, 58.5F, 12.2F, 4.7F, 88},
                                         {0.943F, 13, 49.4F, 10.6F, 4.2F, 96},
                                         {0.997F, 9.8F, 43.8F, 11.6F, 2.6F, 93},
                                         {0.992F, 11, 44, 12, 3, 92}};
constexpr LegSection vastus_medialis[] = {{0.200F, 17.4F, 13.2F, 3.8F, 1.8F, 24},
                                          {0.281F, 10.6F, 26.3F, 10.9F, 4.7F, 146},
                                          {0.321F, 7.3F, 30.2F, 14.2F, 7.9F, 153},
                                          {0.403F, 2.6F, 37.9F, 20, 10.1F, 164},
                                          {0.484F, -0.2F, 44.1F, 20.6F, 11.7F, 169},
                                          {0.566F, -3.6F, 47, 20.3F, 13.9F, 174},
                                          {0.647F, -8.2F, 46.2F, 22, 16, 14},
                                          {0.728F, -12.9F, 43.4F, 24.4F, 17.7F, 27},
                                          {0.810F, -17.2F, 39.7F, 26.2F, 17.1F, 32},
                                          {0.885F, -18.5F, 36.6F, 25.5F, 15, 42},
                                          {0.926F, -15.5F, 36.8F, 21, 11.5F, 52},
                                          {0.962F, -9, 38.5F, 15, 6.5F, 68},
                                          {0.994F, -1, 41, 9, 2.8F, 80}};
constexpr LegSection vastus_intermedius[] = {{0.167F, 35.3F, 10.4F, 6.1F, 1.5F, 106},
                                             {0.248F, 31.2F, 18.6F, 15.1F, 6, 108},
                                             {0.330F, 31.6F, 28.9F, 19.2F, 10.5F, 118},
                                             {0.412F, 30.9F, 35.2F, 21.2F, 13.3F, 120},
                                             {0.495F, 30.4F, 38.4F, 21.7F, 15.2F, 123},
                                             {0.577F, 28.9F, 40, 22.6F, 15.9F, 125},
                                             {0.659F, 26.8F, 41.2F, 23.4F, 15.8F, 124},
                                             {0.741F, 24.6F, 41.6F, 23.3F, 15, 123},
                                             {0.822F, 21.4F, 41.9F, 19.7F, 13, 119},
                                             {0.863F, 19.8F, 41.6F, 17.1F, 10.5F, 123},
                                             {0.904F, 18.4F, 40.6F, 14.2F, 7.3F, 126},
                                             {0.945F, 16.8F, 39.5F, 12.1F, 4.1F, 121},
                                             {0.985F, 13, 39, 10, 2.2F, 92}};
constexpr LegSection vastus_lateralis[] = {{0.084F, 30.2F, 12.4F, 7.9F, 2.3F, 91},
                                           {0.178F, 49.3F, 9.6F, 14, 8, 162},
                                           {0.224F, 51.3F, 8.7F, 19.4F, 10, 5},
                                           {0.316F, 52, 8.1F, 28.9F, 13.1F, 28},
                                           {0.408F, 51.9F, 11.6F, 35.3F, 16.2F, 32},
                                           {0.500F, 51.7F, 16.9F, 37.8F, 17.4F, 28},
                                           {0.592F, 50.5F, 21, 38.1F, 17.6F, 22},
                                           {0.683F, 48.5F, 25.2F, 34.3F, 16.5F, 17},
                                           {0.775F, 45.1F, 27.4F, 28.8F, 13.7F, 14},
                                           {0.866F, 40, 30.5F, 24.5F, 10.9F, 1},
                                           {0.912F, 37.4F, 33.2F, 21.4F, 9.5F, 172},
                                           {0.957F, 33.5F, 35.1F, 16.5F, 8.4F, 163},
                                           {0.990F, 25, 41, 8, 3, 110}};
constexpr LegSection gastrocnemius_medial[] = {
    {0.909F, -14.1F, 4.5F, 4.8F, 1.7F, 134},     {0.936F, -14.2F, -4, 9.2F, 5.5F, 125},
    {0.990F, -11.2F, -20.7F, 11.6F, 8.4F, 76},   {1.048F, -12.7F, -32, 15.5F, 10, 97},
    {1.110F, -14.1F, -35.3F, 20.1F, 12.2F, 132}, {1.174F, -14.7F, -34.9F, 26.2F, 14.4F, 149},
    {1.240F, -16.4F, -32.7F, 33.6F, 17.3F, 162}, {1.304F, -19.5F, -33.4F, 36.7F, 18, 163},
    {1.366F, -22.7F, -37, 34.5F, 16.7F, 155},    {1.428F, -22.8F, -40.7F, 30.5F, 14.5F, 142},
    {1.523F, -17.8F, -42.8F, 24.9F, 11.2F, 124}, {1.588F, -14.3F, -40.3F, 18, 7.3F, 116},
    {1.654F, -9, -34.8F, 5.5F, 1.7F, 118}};
constexpr LegSection gastrocnemius_lateral[] = {
    {0.948F, 28.8F, -6.4F, 8, 3.7F, 16},       {0.972F, 29.2F, -16, 13.1F, 4.3F, 34},
    {1.021F, 25.4F, -31.3F, 15.9F, 5.2F, 60},  {1.076F, 26.3F, -35.8F, 19.2F, 8, 60},
    {1.132F, 25.9F, -39.9F, 21.9F, 11.3F, 62}, {1.187F, 26.6F, -43, 24.3F, 15, 60},
    {1.243F, 27.8F, -46, 26.4F, 15.8F, 62},    {1.300F, 28.7F, -48.2F, 28.4F, 14.8F, 63},
    {1.356F, 29, -49.6F, 28.9F, 13.4F, 63},    {1.413F, 28.8F, -49.2F, 27.7F, 11.3F, 62},
    {1.500F, 26.4F, -46.6F, 21.6F, 7.9F, 62},  {1.558F, 21.2F, -44.3F, 16, 5.3F, 67},
    {1.617F, 17.9F, -39.9F, 8, 2.1F, 71}};
constexpr LegSection soleus[] = {{1.158F, 31.6F, -18.6F, 4.9F, 1.1F, 105},   {1.186F, 26.5F, -17, 10.2F, 5.1F, 123},
                                 {1.242F, 20.9F, -19.4F, 21.1F, 9.4F, 108},  {1.298F, 14.4F, -20.4F, 30.1F, 12.1F, 106},
                                 {1.355F, 9.4F, -20.5F, 35.5F, 14.1F, 106},  {1.412F, 3, -19.7F, 38.2F, 15.8F, 111},
                                 {1.469F, -1.2F, -19.3F, 38.3F, 16.2F, 112}, {1.526F, -3.5F, -19.5F, 36.8F, 15.4F, 111},
                                 {1.585F, -3.6F, -20.8F, 34.2F, 13.7F, 110}, {1.643F, -2.5F, -21.7F, 30.5F, 11, 108},
                                 {1.702F, -1.1F, -22.6F, 25.7F, 8.8F, 103},  {1.789F, -2.4F, -25.9F, 15.8F, 4.9F, 97},
                                 {1.844F, -8.8F, -29.1F, 7, 2.1F, 88}};

constexpr LegSection calcaneal_tendon[] = {{1.580F, 3, -43, 20, 2, 95},     {1.660F, 0, -42, 16, 3, 95},
                                           {1.760F, -3, -38, 11, 3.5F, 95}, {1.860F, -5, -36, 8, 4.5F, 95},
                                           {1.960F, -5, -37, 7, 5, 95},     {2.030F, -4, -42, 8, 4.5F, 95},
                                           {2.090F, -1, -48, 10, 3.5F, 95}};

constexpr std::array<MuscleShape, 12> shapes = {{
    {"semimembranosus", MuscleGroup::hamstrings, Segment::pelvis, Segment::shank_right, semimembranosus, no_muscle},
    {"semitendinosus", MuscleGroup::hamstrings, Segment::pelvis, Segment::shank_right, semitendinosus, 0},
    {"biceps_femoris_long_head", MuscleGroup::hamstrings, Segment::pelvis, Segment::shank_right,
     biceps_femoris_long_head, 3},
    {"biceps_femoris_short_head", MuscleGroup::hamstrings, Segment::thigh_right, Segment::shank_right,
     biceps_femoris_short_head, no_muscle},
    {"rectus_femoris", MuscleGroup::quadriceps, Segment::pelvis, Segment::patella_right, rectus_femoris, 6},
    {"vastus_medialis", MuscleGroup::quadriceps, Segment::thigh_right, Segment::patella_right, vastus_medialis,
     no_muscle},
    {"vastus_intermedius", MuscleGroup::quadriceps, Segment::thigh_right, Segment::patella_right, vastus_intermedius,
     no_muscle},
    {"vastus_lateralis", MuscleGroup::quadriceps, Segment::thigh_right, Segment::patella_right, vastus_lateralis,
     no_muscle},
    {"gastrocnemius_medial", MuscleGroup::triceps_surae, Segment::thigh_right, Segment::foot_right,
     gastrocnemius_medial, 10},
    {"gastrocnemius_lateral", MuscleGroup::triceps_surae, Segment::thigh_right, Segment::foot_right,
     gastrocnemius_lateral, 10},
    {"soleus", MuscleGroup::triceps_surae, Segment::shank_right, Segment::foot_right, soleus, no_muscle},
    {"calcaneal_tendon", MuscleGroup::triceps_surae, Segment::shank_right, Segment::foot_right, calcaneal_tendon,
     no_muscle},
}};

}  // namespace

std::span<const MuscleShape> muscle_shapes() {
  return shapes;
}

}  // namespace mobil
