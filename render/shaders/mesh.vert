// Places a vertex and does everything that can be done per vertex: light, colour, false colour.
// Prefixed with the version, one PIPELINE_* and one LOOK_* definition, and lighting.glsl.

layout(location = 0) in vec3 a_position;
layout(location = 1) in vec4 a_normal; // signed bytes as they are; w: face of an impostor
layout(location = 2) in vec4 a_color;  // sRGB-encoded, straight alpha
layout(location = 3) in vec2 a_uv;
// The draw's record (draw_record.h), once per instance.
layout(location = 4) in vec4 d_row0; // world relative to the eye = rows * (local, 1)
layout(location = 5) in vec4 d_row1;
layout(location = 6) in vec4 d_row2;
layout(location = 7) in vec4 d_color; // sRGB-encoded
layout(location = 8) in uvec4 d_info; // layer, flags and cutoff, id, tint

layout(location = 0) uniform mat4 u_projection;
layout(location = 1) uniform vec4 u_eye;  // w = 1: a point; w = 0: a direction towards the viewer
layout(location = 2) uniform float u_lit; // 0: colours without light

#define FLAG_UNLIT 1u
#define FLAG_DOUBLE_SIDED 2u
#define FLAG_MIRRORED 4u
#define FLAG_BACKGROUND 8u

#if defined PIPELINE_IMPOSTOR_LIT || defined PIPELINE_IMPOSTOR_UNLIT
#define IMPOSTOR
#endif

#if !defined WITHOUT_ID
flat out uint v_id;
#endif
#if !defined PIPELINE_PLAIN
out vec3 v_uv; // with the layer
#endif
#if defined PIPELINE_MASKED
flat out float v_cutoff;
#endif
#if defined LOOK_NORMAL
out vec3 v_normal;
#endif
#if !defined IMPOSTOR
out vec4 v_color;
#elif defined LOOK_TINT
flat out vec3 v_color;
#endif
#if defined PIPELINE_IMPOSTOR_LIT
flat out mat3 v_turn; // object-space normals to world space, up to length
flat out float v_lit; // 1 lit, 0 not
#endif

// Cofactors of the placement: the inverse transpose times the determinant, which turns normals.
mat3 normal_turn(uint flags)
{
    mat3 rows = mat3(cross(d_row1.xyz, d_row2.xyz), cross(d_row2.xyz, d_row0.xyz),
                     cross(d_row0.xyz, d_row1.xyz));
    return transpose((flags & FLAG_MIRRORED) != 0u ? -rows : rows);
}

vec3 normalized(vec3 v)
{
    return v * inversesqrt(max(dot(v, v), 1e-37));
}

void main()
{
    vec4 local = vec4(a_position, 1.0);
    vec3 world = vec3(dot(d_row0, local), dot(d_row1, local), dot(d_row2, local));
    uint flags = d_info.y & 0xffffu;
    gl_Position = u_projection * vec4(world, 1.0);
    // The background keeps its own depth order, behind whatever the tree can hold.
    if ((flags & FLAG_BACKGROUND) != 0u) gl_Position.z *= 1.0 / 1099511627776.0;

    mat3 turn = normal_turn(flags);
    vec3 normal = normalized(turn * a_normal.xyz);
    vec3 to_viewer = u_eye.xyz - world * u_eye.w;
    if ((flags & FLAG_DOUBLE_SIDED) != 0u && dot(normal, to_viewer) < 0.0) normal = -normal;

#if !defined WITHOUT_ID
    v_id = d_info.z;
#endif
#if !defined PIPELINE_PLAIN
    uint layer = d_info.x;
#if defined IMPOSTOR
    layer += uint(a_normal.w);
#endif
    v_uv = vec3(a_uv, float(layer));
#endif
#if defined PIPELINE_MASKED
    v_cutoff = float(d_info.y >> 16) * (1.0 / 65535.0);
#endif
#if defined LOOK_NORMAL
    v_normal = normal;
#endif
#if defined PIPELINE_IMPOSTOR_LIT
    v_turn = turn;
    v_lit = u_lit;
#endif

#if defined LOOK_TINT
    vec3 tint = unpackUnorm4x8(d_info.w).rgb * (0.3 + 0.7 * light_of(normal).g);
#if defined IMPOSTOR
    v_color = tint;
#else
    v_color = vec4(tint, a_color.a * d_color.a);
#endif
#elif !defined IMPOSTOR
    vec3 light = (flags & FLAG_UNLIT) != 0u ? vec3(1.0) : mix(vec3(1.0), light_of(normal), u_lit);
    v_color = vec4(a_color.rgb * d_color.rgb * light, a_color.a * d_color.a);
#endif
}
