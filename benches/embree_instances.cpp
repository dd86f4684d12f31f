// embree_instances MESH.tri FRAMES COLUMNS ROWS SPACING EX EY EZ LX LY LZ VH WxH
//
// A grid of instances of one mesh in the plane y = 0, as a scene file's `instances = { grid = ... }` places them, traced by Embree's
// two-level hierarchy: one scene of the mesh, one scene of instances. Rays, modes and threads are those of `embree_primary`, of which
// this is another `main`. Prints, for each mode, robust or not, the median and the least milliseconds on two threads; and how many
// pixels are covered.
//
// Built by instances.py, beside this file.
#define main primary_main
#include "embree_primary.cpp"
#undef main

static void normalize(float* a) { float n = std::sqrt(a[0]*a[0] + a[1]*a[1] + a[2]*a[2]); for (int i = 0; i < 3; i++) a[i] /= n; }
static void cross(const float* a, const float* b, float* c) { for (int i = 0; i < 3; i++) c[i] = a[(i+1)%3]*b[(i+2)%3] - a[(i+2)%3]*b[(i+1)%3]; }

// The lecture's frame: w against the direction of view, u to the right, v up.
static Camera looking(const float* eye, const float* at, float vh) {
  Camera k; float up[3] = {0, 1, 0};
  for (int i = 0; i < 3; i++) { k.e[i] = eye[i]; k.w[i] = eye[i] - at[i]; }
  normalize(k.w); cross(up, k.w, k.u); normalize(k.u); cross(k.w, k.u, k.v);
  k.d = 1; k.vh = vh; return k;
}

static RTCScene grid(RTCDevice device, RTCScene mesh, bool robust, int columns, int rows, float spacing) {
  RTCScene scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
  rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
  for (int row = 0; row < rows; row++) for (int column = 0; column < columns; column++) {
    RTCGeometry one = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(one, mesh);
    float at[12] = {1, 0, 0, 0, 1, 0, 0, 0, 1, (column - 0.5f*(columns - 1))*spacing, 0, (row - 0.5f*(rows - 1))*spacing};
    rtcSetGeometryTransform(one, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, at);
    rtcCommitGeometry(one); rtcAttachGeometry(scene, one); rtcReleaseGeometry(one);
  }
  rtcCommitScene(scene);
  return scene;
}

int main(int count, char** given) {
  if (count != 14) { fprintf(stderr, "13 arguments are needed, see the source\n"); return 1; }
  Camera of_file; Mesh mesh = load_mesh(given[1], of_file);
  int frames = atoi(given[2]), columns = atoi(given[3]), rows = atoi(given[4]);
  float spacing = atof(given[5]), eye[3], at[3];
  for (int i = 0; i < 3; i++) { eye[i] = atof(given[6 + i]); at[i] = atof(given[9 + i]); }
  Camera camera = looking(eye, at, atof(given[12]));
  int width, height; sscanf(given[13], "%dx%d", &width, &height);
  RTCDevice device = rtcNewDevice("threads=2");
  std::vector<uint32_t> ids((size_t)width*height);
  for (int robust: {0, 1}) {
    double ms; RTCScene one = build(device, mesh, RTC_BUILD_QUALITY_HIGH, robust, ms);
    double start = now_ms(); RTCScene all = grid(device, one, robust, columns, rows, spacing);
    printf("build|%s|mesh %.1f ms|instances %.1f ms\n", robust ? "robust" : "fast", ms, now_ms() - start);
    std::vector<int> modes = {1, 8, 16};
#ifndef EMBREE4
    modes.push_back(100); modes.push_back(116);
#endif
    for (int mode: modes) {
      std::vector<double> times;
      for (int frame = 0; frame <= frames; frame++) {
        Job job{all, camera, width, height, ids.data(), true, 8};
        pool.arm(); double begun = now_ms(); render(job, mode, 2); if (frame) times.push_back(now_ms() - begun);
      }
      size_t seen = 0; for (uint32_t id: ids) seen += id != 0xFFFFFFFFu;
      printf("trace|%s|m%d|median %.2f ms|least %.2f ms|covered %zu\n", robust ? "robust" : "fast", mode, median(times), best(times), seen);
      fflush(stdout);
    }
  }
}
