// What tessera's own warnings find here is none of its business.
int narrowed(long number) {
    int number_too = 0;
    {
        int number_too = (int)number;
        return number_too;
    }
    return number;
}
