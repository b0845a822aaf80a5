/* A host with the ABI of MSVC and without its run-time library: structs, calls and mobil.lib (the script links it). */
#include <mobil/mobil.h>
__declspec(dllimport) void ExitProcess(unsigned code);
int _fltused = 1;
void mainCRTStartup(void) {
  static char line[256]; static float pose[48 * 7]; mobil_options o; mobil_person p; mobil_sim* s = 0; mobil_id id;
  if (mobil_interface() < MOBIL_INTERFACE) ExitProcess(10);
  if (mobil_defaults(MOBIL_OPTIONS, &o, sizeof o)) ExitProcess(11);
  if (mobil_create(&o, &s, line, sizeof line)) ExitProcess(12);
  if (mobil_defaults(MOBIL_PERSON, &p, sizeof p)) ExitProcess(13);
  if (mobil_spawn(s, &p, 0, 1, 0, &id)) ExitProcess(14);
  if (mobil_tick(s, 60)) ExitProcess(15);
  if (mobil_poses(s, &id, 1, 0, pose, 0)) ExitProcess(16);
  mobil_destroy(s);
  ExitProcess(pose[2] > 0.5f ? 0 : 17);
}
