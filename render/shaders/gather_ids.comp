// Takes the id of one pixel of each block of STEP x STEP: row by row into a buffer. Prefixed with
// the version.

#define STEP 4 // PROM_ID_STEP

layout(local_size_x = 64) in;
layout(binding = 0) uniform usampler2D u_ids;
layout(location = 0) uniform uint u_columns;
layout(location = 1) uniform uvec2 u_offset; // of the pixel in its block
layout(std430, binding = 0) writeonly restrict buffer Samples { uint o_ids[]; };

void main()
{
    uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= u_columns) return;
    o_ids[at.y * u_columns + at.x] = texelFetch(u_ids, ivec2(at * STEP + u_offset), 0).r;
}
