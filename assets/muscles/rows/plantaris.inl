// Not among the published regressions. The belly is 9.6 cm long and 1.8 cm wide (means of 146 legs; Lee, Heo, Kim,
// Hwang: Morphological classification of the plantaris muscle origin, a cadaveric study, 2025). As a spheroid 0.53 as
// thick as wide, the mean of its sections there, it has 8.6 cm³. Its share of 0.0015 of the limb's volume assumes
// owners of 1.65 m and 60 kg, which is a guess. Path: the origin is the area centroid of its patch on the femur of
// BodyParts3D as drawn by Z-Anatomy (CC BY-SA 4.0; https://www.z-anatomy.com). It runs round the condyle and ends as
// the lateral gastrocnemius does. Fibres, pennation and belly: Wickiewicz, Roy, Powell & Edgerton, Clin. Orthop. Relat.
// Res. 179, 1983; no model has its tendon. Drawn thinner than measured, because the measured man's is thicker than in
// life, especially its tendon.
{.name = "plantaris",
 .group = Muscle::triceps_surae,
 .origin = Segment::thigh_right,
 .insertion = Segment::foot_right,
 .path = {
     in_thigh(0.0190, -0.3781, -0.0004),
     behind(on_femur(-0.03, -0.4018, 0.0274)),
     on_calcaneus(0, 0.031, -0.0053),
 },
 .limb_share = 0.0015,
 .offset_cm3 = 0,
 .fibre_m = 0.039,
 .pennation_deg = 5.0,
 .belly_m = 0.085,
 .sections = {
     {0.903F, 22.1F, 14.2F, 7.1F, 3.9F, 22},
     {0.965F, 13.3F, -17.6F, 11.6F, 8, 111},
     {1.062F, 14.7F, -29.7F, 11.8F, 5.9F, 88},
     {1.159F, 16.8F, -31, 9.3F, 3.7F, 90},
     {1.257F, 6.2F, -31.6F, 3.6F, 2.7F, 126},
     {1.354F, -6.3F, -35.1F, 3, 2, 133},
     {1.451F, -19.5F, -33.3F, 3, 1.9F, 124},
     {1.549F, -27.1F, -27, 2.7F, 1.2F, 138},
     {1.646F, -23.5F, -22.5F, 2.8F, 0.7F, 135},
     {1.743F, -18.3F, -24.1F, 3, 1.5F, 144},
     {1.841F, -18.1F, -26.6F, 2.2F, 1.8F, 137},
     {1.938F, -18.4F, -31.5F, 2.4F, 2, 109},
     {2.035F, -20, -35.3F, 2.5F, 2.1F, 92},
     {2.097F, -23, -33.9F, 2.7F, 2.2F, 72},
 },
 .not_drawn = 10,
 .drawn_above = {{0.896F, 22.6F, 16.2F, 2.4F, 1.6F, 22}},
 .drawn_below = {
     {1.257F, 6.2F, -31.6F, 2.4F, 1.5F, 126},
     {1.354F, -6.3F, -35.1F, 2.1F, 1.0F, 133},
     {1.451F, -19.5F, -33.3F, 2, 0.9F, 124},
     {1.549F, -27.1F, -27, 2, 0.9F, 138},
     {1.646F, -23.5F, -24.5F, 2, 0.9F, 135},
     {1.743F, -18.3F, -26.1F, 2, 0.9F, 144},
     {1.841F, -18.1F, -28.6F, 2, 0.9F, 137},
     {1.938F, -18.4F, -32.5F, 2, 0.9F, 109},
     {2.035F, -20, -35.3F, 2.1F, 0.9F, 92},
     {2.097F, -20, -35.9F, 2.4F, 1, 72},
 },
 .lies_on = "soleus"},
