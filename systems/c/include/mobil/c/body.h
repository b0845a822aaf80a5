/* Bodies: lengths, masses and inertias of segments, and bones of a host's skeleton by name. A part of mobil.h, which
 * includes it. Since interface 4. */
#ifndef MOBIL_BODY_H
#define MOBIL_BODY_H

/* ---- Body ------------------------------------------------------------------------------------------------------- */

/* A segment of a person. All vectors are in the frame in which mobil_poses writes the segment or its parent, in the
 * axes and the unit of mobil_options. In the anatomical position, upright with palms ahead, all rotations are identity.
 */
typedef struct mobil_segment {
  size_t size;
  int parent;             /* the pelvis is its own */
  float offset[3];        /* its joint, from the parent's joint; of the pelvis, from the ground below it */
  float tip[3];           /* its far end, from its joint */
  float mass_kg;          /* those of all segments add up to the person's */
  float centre[3];        /* of mass, from its joint */
  float inertia_kg_m2[3]; /* about the centre and the axes of its frame, which are principal axes */
} mobil_segment;
/* Writes the MOBIL_SEGMENTS segments of a person, `stride` bytes apart (0: tightly packed). The first struct's `size`
 * applies to all. */
MOBIL_API int mobil_get_body(mobil_sim* sim, mobil_id id, mobil_segment* out, size_t stride);

/* Finds the segments of a host's bones by name, because programs number bones in another order. `out` receives a
 * segment for each bone, or -1. A name matches if it is a segment's, or ends with one after a character that is neither
 * letter nor digit, as in person_7_head. MOBIL_MISSING if no bone matches. */
MOBIL_API int mobil_segments_of(const char* const* names, size_t count, int* out);

#endif
