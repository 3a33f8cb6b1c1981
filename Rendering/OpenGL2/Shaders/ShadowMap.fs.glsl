//VTK::System::Dec
// Shadow map, fragment stage: only the depth, which the rasteriser writes, is wanted.
void main()
{
}
