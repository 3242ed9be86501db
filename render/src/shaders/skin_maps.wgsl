// The four maps of the skin (HEADSHOP 4.4), as every pass over it is given them.

@group(2) @binding(0) var map_sampler: sampler;
// Colour as the square root of linear light, lips and brows in it; a: how much pores show.
@group(2) @binding(1) var colour_map: texture_2d<f32>;
// Gloss, depth of the fine structure, how much light shines through, floors of wrinkles (above 0.5 of the first layer,
// below of the second).
@group(2) @binding(2) var mask_map: texture_2d<f32>;
// Slopes across and up of both layers of wrinkles; 0.5 is flat.
@group(2) @binding(3) var wrinkle_map: texture_2d<f32>;
// Slopes across and up of the fine structure, how deep in a furrow, in a pore.
@group(2) @binding(4) var grain_map: texture_2d<f32>;
@group(2) @binding(5) var tile_sampler: sampler;
