// Colours a pixel. Prefixed as mesh.vert.

#if defined PIPELINE_IMPOSTOR_LIT || defined PIPELINE_IMPOSTOR_UNLIT
#define IMPOSTOR
#endif

layout(binding = 0) uniform sampler2DArray u_material; // repeats
layout(binding = 1) uniform sampler2DArray u_picture;  // of impostors: six faces, then their normals

#if defined PIPELINE_BLENDED
layout(location = 0, index = 0) out vec4 o_color; // premultiplied; alpha 1: drawn
layout(location = 0, index = 1) out vec4 o_cover; // what it hides of what is behind it
#else
layout(location = 0) out vec4 o_color;
#endif

#if !defined WITHOUT_ID
flat in uint v_id;
layout(location = 1) out uint o_id;
#endif
#if !defined PIPELINE_PLAIN
in vec3 v_uv;
#endif
#if defined PIPELINE_MASKED
flat in float v_cutoff;
#endif
#if defined LOOK_NORMAL
in vec3 v_normal;
#endif
#if !defined IMPOSTOR
in vec4 v_color;
#elif defined LOOK_TINT
flat in vec3 v_color;
#endif
#if defined PIPELINE_IMPOSTOR_LIT
flat in mat3 v_turn;
flat in float v_lit;
#endif

// The colour before the look; discards what is not there.
vec4 surface()
{
#if defined PIPELINE_PLAIN
    return v_color;
#elif defined PIPELINE_TEXTURED
    return vec4(texture(u_material, v_uv).rgb * v_color.rgb, 1.0);
#elif defined PIPELINE_MASKED || defined PIPELINE_BLENDED
    vec4 texel = texture(u_material, v_uv);
#if defined PIPELINE_MASKED
    if (texel.a * v_color.a < v_cutoff) discard;
#else
    if (texel.a * v_color.a < 1.0 / 255.0) discard;
#endif
#if defined LOOK_TINT
    texel.rgb = vec3(1.0);
#endif
    return texel * v_color;
#else
    vec4 texel = texture(u_picture, v_uv);
    if (texel.a < 0.5) discard;
    return texel;
#endif
}

#if defined PIPELINE_IMPOSTOR_LIT
vec3 pictured_normal()
{
    vec3 texel = texture(u_picture, v_uv + vec3(0.0, 0.0, 6.0)).xyz * 2.0 - 1.0;
    return normalize(v_turn * texel);
}
#endif

void main()
{
    vec4 color = surface();
#if defined LOOK_NORMAL
#if defined PIPELINE_IMPOSTOR_LIT
    vec3 normal = pictured_normal();
#else
    vec3 normal = normalize(v_normal);
#endif
    o_color = vec4(normal * 0.5 + 0.5, 1.0);
#elif defined PIPELINE_BLENDED
    o_color = vec4(color.rgb * color.a, 1.0);
    o_cover = vec4(color.a);
#elif defined LOOK_TINT && defined IMPOSTOR
    o_color = vec4(v_color, 1.0);
#elif defined PIPELINE_IMPOSTOR_LIT
    vec3 light = light_of(pictured_normal());
    o_color = vec4(color.rgb * mix(vec3(1.0), light, v_lit), 1.0);
#else
    o_color = vec4(color.rgb, 1.0);
#endif
#if !defined WITHOUT_ID
    o_id = v_id;
#endif
}
