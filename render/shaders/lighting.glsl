// The light of every scene: a warm sun from the upper side and a sky that is bluish above and
// brownish below. Chosen by taste, so that a white surface that faces the sun stays just below 1.
const vec3 sun_direction = vec3(0.4243, 0.7576, 0.4960); // towards the sun, unit length
const vec3 sun_color = vec3(0.70, 0.66, 0.58);
const vec3 sky_ambient = vec3(0.26, 0.30, 0.37);
const vec3 ground_ambient = vec3(0.17, 0.15, 0.12);

// Lambert sun plus hemisphere ambient for a unit normal in world space, encoded as colours are.
//
// Colours stay encoded from the texture to the target: under a power law
// encode(albedo * light) = encode(albedo) * encode(light), so light multiplies encoded colours
// and no texel and no pixel is converted (sRGB textures and targets quadruple the time of a
// pixel on software devices). The exponent is that of the power law nearest to sRGB.
vec3 light_of(vec3 normal)
{
    float up = normal.y * 0.5 + 0.5;
    vec3 linear = mix(ground_ambient, sky_ambient, up) +
                  sun_color * max(dot(normal, sun_direction), 0.0);
    // pow(linear, 1 / 2.2) to within 0.003 on [0.1, 1], fitted; lit pictures need it per pixel.
    return sqrt(linear) * ((0.1258 * linear - 0.2473) * linear + 1.1245);
}
