// Code that tessera's warnings would report; they must not apply to a client.
int narrowed(long number) {
    int number_too = 0;
    {
        int number_too = (int)number;
        return number_too;
    }
    return number;
}
